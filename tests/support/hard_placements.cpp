// SPDX-License-Identifier: MIT
#include "support/hard_placements.h"

#include <cmath>
#include <random>

#include "exact/triangle_contact.h"
#include "support/hard_meshes.h"

namespace cdprep::test {
namespace {

Placement shifted(double x, double y, double z) {
    return Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z}).value());
}

Placement still() {
    return Placement::b_moves(Pose());
}

Pose turn() {
    return Pose::from_quaternion(5, 1, 2, 3, {0.25, -0.5, 0.125}).value();
}

/// Valence 4 at each corner, so that counts are known by hand.
TestMesh octahedron() {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{{0, 2, 4}},
             {{2, 1, 4}},
             {{1, 3, 4}},
             {{3, 0, 4}},
             {{2, 0, 5}},
             {{1, 2, 5}},
             {{3, 1, 5}},
             {{0, 3, 5}}}};
}

/// Faces x = 0 of two cubes, `gap` apart; the second shifted along the face.
void add_cubes_with_a_gap(std::vector<HardPlacement>& all) {
    const TestMesh left = moved_by(unit_cube(), 1, {-1, 0, 0});
    for (const double gap : {1e-16, 1e-12, 1e-8, 1e-6, 1e-4}) {
        TestMesh right = unit_cube();
        for (Double3& p : right.positions) {
            if (p.x == 0) p.x = gap;
        }
        const std::string name = "cube gap " + std::to_string(static_cast<int>(std::log10(gap)));
        all.push_back({name, left, right, still(), 0});
        all.push_back({name + ", shifted", left, right, shifted(0, 0.25, 0.125), 0});
    }
}

void add_cubes(std::vector<HardPlacement>& all) {
    const TestMesh cube = unit_cube();
    const TestMesh beside = moved_by(cube, 1, {1, 0, 0});
    all.push_back({"cube face = face", cube, cube, shifted(1, 0, 0), 62});
    all.push_back({"cube part of face", cube, cube, shifted(1, 0.25, 0.125), 15});
    add_cubes_with_a_gap(all);
    for (const double depth : {1e-16, 1e-12, 1e-8}) {
        const std::string name =
            "cube overlap " + std::to_string(static_cast<int>(std::log10(depth)));
        all.push_back({name, cube, cube, shifted(1 - depth, 0, 0), 52});
    }
    all.push_back(
        {"cube face = face, turned alike", cube, beside, Placement::world(turn(), turn()), 62});
}

void add_points_of_contact(std::vector<HardPlacement>& all) {
    const TestMesh cube = unit_cube();
    all.push_back({"vertex on face", cube, octahedron(), shifted(0.25, 0.5, 2), 4});
    all.push_back({"vertex on edge", cube, octahedron(), shifted(0.5, 0.5, 2), 8});
    all.push_back({"vertex on vertex", cube, octahedron(), shifted(1, 0, 2), 16});
    all.push_back({"edge across edge", cube, octahedron(), shifted(-0.5, -0.5, 0.5), 4});
    const TestMesh flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{{0, 1, 2}}}};
    const TestMesh standing{{{0.5, 0.5, 0}, {1.5, 0.75, 0}, {1, 1, 3}}, {{{0, 1, 2}}}};
    all.push_back({"edge lying in face", flat, standing, still(), 1});
}

void add_others_with_cubes(std::vector<HardPlacement>& all) {
    const TestMesh slice{{{-9, -9, 0.25}, {9, -9, 0.5}, {0, 9, 0.75}}, {{{0, 1, 2}}}};
    all.push_back({"1 triangle x cube", slice, unit_cube(), still(), 8});
    TestMesh flawed = unit_cube();
    for (std::uint32_t i = 0; i < 5; ++i) flawed.triangles.push_back({{i % 2, i % 2, i % 2}});
    all.push_back({"cube with 5 zero-area triangles", flawed, slice, still(), 8});
}

void add_sheets(std::vector<HardPlacement>& all) {
    const TestMesh sheet = grid_sheet(20, 20);
    TestMesh tilted = sheet;
    for (Double3& p : tilted.positions) p.z = 1e-9 * p.x;
    all.push_back({"sheets tilted 1e-9", sheet, tilted, shifted(0.3125, 0.1875, 0), 79});
    all.push_back({"sheets 1e-9 apart", sheet, sheet, shifted(0.3125, -0.1875, 1e-9), 0});
    all.push_back({"sheets coplanar", sheet, sheet, shifted(0.3125, -0.1875, 0), 3841});
}

/// `count` triangles of length 1 and width 1 / aspect across the unit cube, from
/// near one face x to near the other; along y with `across`.
TestMesh needles(std::uint32_t seed, int count, double aspect, bool across) {
    std::mt19937 random(seed);
    const auto draw = [&random] { return static_cast<double>(random()) * 0x1p-32; };
    TestMesh mesh;
    for (int i = 0; i < count; ++i) {
        const double y = draw(), z = draw();
        const Double3 from = {0, y, z};
        const Double3 to = {1, y + 0.25 * (draw() - 0.5), z + 0.25 * (draw() - 0.5)};
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (Double3 p : {from, to, Double3{to.x, to.y + 1 / aspect, to.z + 1 / aspect}}) {
            if (across) std::swap(p.x, p.y);
            mesh.positions.push_back(p);
        }
        mesh.triangles.push_back({{base, base + 1, base + 2}});
    }
    return mesh;
}

void add_needles(std::vector<HardPlacement>& all) {
    const auto add = [&](double aspect, bool across, std::size_t pairs) {
        const int count = across ? 200 : 300;
        all.push_back({"needles " + std::string(across ? "across, 1 : " : "along, 1 : ") +
                           std::to_string(std::lround(aspect)),
                       needles(1, count, aspect, false), needles(2, count, aspect, across), still(),
                       pairs});
    };
    add(1e8, false, 0);
    add(1e4, false, 0);
    add(1e2, false, 92);
    add(1e4, true, 2);
    add(1e2, true, 341);
}

/// Every coordinate rounded to a multiple of `step`, without what becomes collinear.
TestMesh snapped(const TestMesh& fine, double step) {
    TestMesh mesh = on_grid(fine, step);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        const auto at = [&](std::size_t i) { return mesh.positions[t.vertex[i]]; };
        return is_degenerate({at(0), at(1), at(2)});
    });
    return mesh;
}

}  // namespace

std::vector<HardPlacement> hard_placements() {
    std::vector<HardPlacement> all;
    add_cubes(all);
    add_points_of_contact(all);
    add_others_with_cubes(all);
    add_sheets(all);
    add_needles(all);
    return all;
}

std::vector<HardPlacement> hard_placements_of(const TestMesh& horse) {
    const TestMesh grid = snapped(horse, 1.0 / 64);
    return {
        {"horse on itself", horse, horse, still(), 98006},
        {"horse on itself, turned alike", horse, horse, Placement::world(turn(), turn()), 98006},
        {"horse on a grid, shifted by (1,0,0)/64", grid, grid, shifted(1. / 64, 0, 0), 33130},
        {"horse on a grid, shifted by (3,1,2)/64", grid, grid, shifted(3. / 64, 1. / 64, 2. / 64),
         9490}};
}

std::vector<HardPlacement> hard_placements_of(const TestMesh& armadillo, const TestMesh& horse) {
    constexpr std::size_t kPairs = 447;
    const Double3 t = {0.25, 0.0625, 0.125};
    const auto by = [&](double scale) {
        return Pose::from_quaternion(5, 1, 2, 3, {scale * t.x, scale * t.y, scale * t.z}).value();
    };
    std::vector<HardPlacement> all = {
        {"armadillo x horse", armadillo, horse, Placement::b_moves(by(1)), kPairs}};
    for (const double scale : {1e-6, 1e6, 1e-12}) {
        all.push_back({"the same, scaled 1e" + std::to_string(std::lround(std::log10(scale))),
                       moved_by(armadillo, scale, {}), moved_by(horse, scale, {}),
                       Placement::b_moves(by(scale)), kPairs});
    }
    const Pose far = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 1e6, 1e6, 1e6}).value();
    const Pose far_b = Pose::from_quaternion(5, 1, 2, 3, {1e6 + t.x, 1e6 + t.y, 1e6 + t.z}).value();
    all.push_back(
        {"the same, both poses at 1e6", armadillo, horse, Placement::world(far, far_b), kPairs});
    TestMesh moved_horse = horse;
    for (Double3& p : moved_horse.positions) p = transform_point(far_b, p);
    all.push_back({"the same, vertices at 1e6", moved_by(armadillo, 1, {1e6, 1e6, 1e6}),
                   moved_horse, still(), kPairs});
    return all;
}

}  // namespace cdprep::test
