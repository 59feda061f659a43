// SPDX-License-Identifier: MIT
#include "support/defect_zoo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace cdprep::test {
namespace {

/// [0, 8]^3, outward.
TestMesh cube() {
    return moved_by(unit_cube(), 8, {0, 0, 0});
}

TestMesh cube_at(const Double3& corner, double size) {
    return moved_by(unit_cube(), size, corner);
}

/// Outward when d lies behind a, b, c, seen counter-clockwise.
TestMesh tetrahedron(const Double3& a, const Double3& b, const Double3& c, const Double3& d) {
    return {{a, b, c, d}, {{{0, 1, 2}}, {{0, 3, 1}}, {{1, 3, 2}}, {{2, 3, 0}}}};
}

/// Equal positions become one vertex, the first.
TestMesh joined_where_equal(const TestMesh& mesh) {
    TestMesh result;
    result.triangles = mesh.triangles;
    for (Triangle& triangle : result.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) {
            const Double3& p = mesh.positions[vertex];
            const auto at = std::find(result.positions.begin(), result.positions.end(), p);
            vertex = static_cast<std::uint32_t>(at - result.positions.begin());
            if (at == result.positions.end()) result.positions.push_back(p);
        }
    }
    return result;
}

TestMesh with_triangle(TestMesh mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({{a, b, c}});
    return mesh;
}

TestMesh with_vertex(TestMesh mesh, const Double3& p) {
    mesh.positions.push_back(p);
    return mesh;
}

/// One triangle uses its first corner by another number.
TestMesh cube_with_a_corner_written_twice() {
    TestMesh mesh = cube();
    const std::uint32_t vertex = mesh.triangles[5].vertex[0];
    mesh.positions.push_back(mesh.positions[vertex]);
    mesh.triangles[5].vertex[0] = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    return mesh;
}

/// A square pyramid whose base is cut along a diagonal with a vertex on one side of it, the
/// flat triangle that closes it between.
TestMesh pyramid_with_a_flat_triangle() {
    return {{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}, {4, 4, 8}, {4, 4, 0}},
            {{{0, 1, 4}},
             {{1, 2, 4}},
             {{2, 3, 4}},
             {{3, 0, 4}},
             {{0, 2, 1}},
             {{0, 5, 2}},  // flat
             {{0, 3, 5}},
             {{5, 3, 2}}}};
}

TestMesh cube_with_first_triangle_turned() {
    TestMesh mesh = cube();
    std::swap(mesh.triangles[0].vertex[1], mesh.triangles[0].vertex[2]);
    return mesh;
}

TestMesh cube_without_first_triangle() {
    TestMesh mesh = cube();
    mesh.triangles.erase(mesh.triangles.begin());
    return mesh;
}

TestMesh cube_with_first_triangle_twice(bool opposite) {
    const TestMesh mesh = cube();
    const auto [a, b, c] = mesh.triangles[0].vertex;
    return opposite ? with_triangle(mesh, a, c, b) : with_triangle(mesh, a, b, c);
}

TestMesh three_sheets_on_an_edge() {
    return {{{0, 0, 0}, {0, 0, 8}, {8, 0, 4}, {-8, 8, 4}, {-8, -8, 4}},
            {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}}};
}

TestMesh vertex_within_an_edge() {
    return {{{0, 0, 0}, {8, 0, 0}, {4, 6, 0}, {4, -6, 0}, {4, 0, 0}},
            {{{0, 1, 2}}, {{0, 3, 4}}, {{4, 3, 1}}}};
}

/// The big one's base lies in z = 0; the small one's apex points down through it.
TestMesh tetrahedron_through_a_face(double apex) {
    return joined(tetrahedron({-32, -32, 0}, {32, -32, 0}, {0, 32, 0}, {0, 0, -64}),
                  tetrahedron({-2, -2, 8}, {2, -2, 8}, {0, 2, 8}, {0, -1, apex}));
}

TestMesh triangle_on_a_face() {
    const TestMesh base = tetrahedron({-32, -32, 0}, {32, -32, 0}, {0, 32, 0}, {0, 0, -64});
    return joined(base, {{{-2, -2, 0}, {2, -2, 0}, {0, 2, 0}}, {{{0, 1, 2}}}});
}

TestMesh gap_between_triangles() {
    constexpr double kGap = -0.125;
    return {{{0, 0, 0}, {8, 0, 0}, {4, 6, 0}, {0, kGap, 0}, {4, -6, 0}, {8, kGap, 0}},
            {{{0, 1, 2}}, {{3, 4, 5}}}};
}

struct Box {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -std::numeric_limits<double>::infinity();
};

/// Of x, over finite coordinates.
Box extent_of(const TestMesh& mesh) {
    Box box;
    for (const Double3& p : mesh.positions) {
        if (!std::isfinite(p.x)) continue;
        box.lowest = std::min(box.lowest, p.x);
        box.highest = std::max(box.highest, p.x);
    }
    return box;
}

}  // namespace

TestMesh moebius_strip(int count) {
    constexpr double kGrid = 8;
    constexpr double kRadius = 64;
    constexpr double kHalfWidth = 16;
    TestMesh strip;
    for (int i = 0; i < count; ++i) {
        const double turn = 2 * std::numbers::pi * i / count;
        for (const double side : {-kHalfWidth, kHalfWidth}) {
            const double reach = kRadius + side * std::cos(turn / 2);
            const auto on_grid = [](double x) { return std::round(x * kGrid) / kGrid; };
            strip.positions.push_back({on_grid(reach * std::cos(turn)),
                                       on_grid(reach * std::sin(turn)),
                                       on_grid(side * std::sin(turn / 2))});
        }
    }
    for (int i = 0; i < count; ++i) {
        const auto a = static_cast<std::uint32_t>(2 * i);
        const bool last = i + 1 == count;
        // Half a turn: the sides have changed places.
        const std::uint32_t c = last ? 1 : a + 2;
        const std::uint32_t d = last ? 0 : a + 3;
        strip.triangles.push_back({{a, c, a + 1}});
        strip.triangles.push_back({{a + 1, c, d}});
    }
    return strip;
}

std::vector<ZooAnimal> defect_zoo() {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    constexpr std::uint32_t kNoVertex = 1000000;
    const TestMesh sound = cube();
    const auto corner = static_cast<std::uint32_t>(sound.positions.size());
    std::vector<ZooAnimal> zoo;
    zoo.push_back({"sound cube", sound, {}});
    zoo.push_back({"coordinate is not a number",
                   with_triangle(with_vertex(sound, {kNaN, 0, 0}), 0, 1, corner),
                   {{101, 1}}});
    zoo.push_back({"index out of range", with_triangle(sound, 0, 1, kNoVertex), {{102, 1}}});
    zoo.push_back({"unreferenced vertex", with_vertex(sound, {4, 4, 4}), {{104, 1}}});
    zoo.push_back({"vertex written twice", cube_with_a_corner_written_twice(), {{105, 1}}});
    zoo.push_back({"repeated corner", with_triangle(sound, 0, 0, 1), {{201, 1}}});
    zoo.push_back({"zero area", pyramid_with_a_flat_triangle(), {{202, 1}}});
    // Height 1 over 2^34: half of that is below 1e-10.
    zoo.push_back({"sliver",
                   tetrahedron({0, 0, 0}, {0x1p34, 0, 0}, {0x1p33, 1, 0}, {0x1p33, 0, -0x1p33}),
                   {{203, 1}}});
    zoo.push_back({"triangle twice", cube_with_first_triangle_twice(false), {{204, 1}, {303, 3}}});
    zoo.push_back(
        {"triangle of both windings", cube_with_first_triangle_twice(true), {{205, 1}, {303, 3}}});
    zoo.push_back({"hole", cube_without_first_triangle(), {{301, 3}, {302, 1}}});
    zoo.push_back(
        {"three sheets on an edge", three_sheets_on_an_edge(), {{301, 6}, {302, 1}, {303, 1}}});
    zoo.push_back({"cubes sharing an edge",
                   joined_where_equal(joined(sound, cube_at({8, 8, 0}, 8))),
                   {{303, 1}}});
    zoo.push_back({"cubes sharing a vertex",
                   joined_where_equal(joined(sound, cube_at({8, 8, 8}, 8))),
                   {{304, 1}}});
    zoo.push_back({"triangle turned", cube_with_first_triangle_turned(), {{305, 3}}});
    zoo.push_back({"moebius strip", moebius_strip(12), {{301, 24}, {302, 1}, {305, 1}, {306, 1}}});
    zoo.push_back(
        {"t-junction", vertex_within_an_edge(), {{301, 7}, {302, 1}, {304, 2}, {307, 1}}});
    zoo.push_back({"inside out", reversed(sound), {{401, 1}}});
    zoo.push_back({"nested", joined(sound, cube_at({2, 2, 2}, 4)), {{402, 1}}, 2});
    zoo.push_back({"crossing", tetrahedron_through_a_face(-4), {{403, 1}, {501, 3}}, 2});
    zoo.push_back({"touching", tetrahedron_through_a_face(0), {{502, 3}}, 2});
    zoo.push_back(
        {"overlap in a plane", triangle_on_a_face(), {{301, 3}, {302, 1}, {403, 1}, {503, 1}}, 2});
    zoo.push_back(
        {"cubes nearly touching", joined(sound, cube_at({8.125, 0, 0}, 8)), {{106, 4}}, 2});
    zoo.push_back({"gap", gap_between_triangles(), {{106, 2}, {301, 6}, {302, 2}, {308, 4}}, 2});
    return zoo;
}

ZooAnimal side_by_side(const ZooAnimal& first, const ZooAnimal& second) {
    constexpr double kApart = 1024;
    ZooAnimal both;
    both.name = first.name + " beside " + second.name;
    const double shift =
        std::ceil(extent_of(first.mesh).highest - extent_of(second.mesh).lowest) + kApart;
    both.mesh = joined(first.mesh, moved_by(second.mesh, 1, {shift, 0, 0}));
    both.found = first.found;
    for (const auto& [rule, count] : second.found) both.found[rule] += count;
    both.components = first.components + second.components;
    return both;
}

ZooAnimal scaled_by(ZooAnimal animal, int exponent) {
    animal.mesh = moved_by(animal.mesh, std::ldexp(1.0, exponent), {0, 0, 0});
    return animal;
}

}  // namespace cdprep::test
