// SPDX-License-Identifier: MIT
#include "support/hard_meshes.h"

#include <cmath>
#include <utility>

#include "support/defect_zoo.h"
#include "support/hard_placements.h"

namespace cdprep::test {
namespace {

constexpr double g = 0x1p-20;  ///< one grid step

using Cases = std::vector<HardMeshes>;
using Pairs = std::vector<TrianglePair>;

Pose by_rows(const std::array<double, 9>& r, const Double3& t) {
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x, t.y, t.z})
        .value();
}

TestMesh one_triangle(const Double3& p, const Double3& q, const Double3& r) {
    return {{p, q, r}, {{{0, 1, 2}}}};
}

TestMesh bumpy_sheet(int n) {
    TestMesh sheet = grid_sheet(n, n);
    for (Double3& p : sheet.positions) p.z = std::fmod(p.x * 7 + p.y * 5, 3) / 8;
    return sheet;
}

/// About another axis: x becomes z, z becomes y, y becomes x.
TestMesh axes_renamed(TestMesh mesh) {
    for (Double3& p : mesh.positions) p = {p.y, p.z, p.x};
    return mesh;
}

/// Each with each, the first `count` of the other.
Pairs first_with_all(std::uint32_t count, std::uint32_t others) {
    Pairs pairs;
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t j = 0; j < others; ++j) pairs.push_back({i, j});
    }
    return pairs;
}

void add_themselves(Cases& all, bool full) {
    const int n = full ? 40 : 8;
    all.push_back({"B01 a bumpy sheet and itself", bumpy_sheet(n), bumpy_sheet(n)});
    const TestMesh ball = on_grid(icosphere(full ? 4 : 2));
    all.push_back({"B01 a ball and itself", ball, ball});
    const TestMesh soup = coarse_grid_soup(7, full ? 300 : 30, 2);
    all.push_back({"B01 a soup and itself", soup, soup});
}

// A body that is star-shaped from the origin holds its copies that are scaled down: every ray
// meets each surface once. What rounding to the grid moves is far less than the gap.
void add_shells(Cases& all, bool full) {
    const TestMesh ball = icosphere(full ? 6 : 3);
    HardMeshes shells = {"B02 nested shells", on_grid(moved_by(ball, 1.001, {})), on_grid(ball)};
    shells.closed = shells.proper = Pairs{};
    shells.is_nested = true;
    all.push_back(std::move(shells));
}

// By construction nothing of the one plane is in the other.
void add_sheets(Cases& all, bool full) {
    const TestMesh sheet = grid_sheet(full ? 707 : 20, full ? 707 : 20);
    for (const double height : {g, -0x1p-40}) {
        HardMeshes sheets = {"B03 sheets " + std::to_string(std::ilogb(height)) + " bits apart",
                             sheet, moved_by(sheet, 1, {0.25, 0.25, height})};
        sheets.closed = sheets.proper = Pairs{};
        all.push_back(std::move(sheets));
    }
    const TestMesh small = grid_sheet(8, 8);
    all.push_back({"B03 sheets in one plane", small, moved_by(small, 1, {0.25, 0.25, 0})});
}

void add_tori(Cases& all, bool full) {
    const int n = full ? 96 : 24;
    for (const double tube : {0.5, 1.0, 1.25}) {
        const TestMesh one = on_grid(torus(2, tube, n, n / 2));
        const TestMesh other =
            on_grid(moved_by(axes_renamed(torus(2, tube, n, n / 2)), 1, {2, 0, 0}));
        all.push_back(
            {"B04 interlocked tori, tube " + std::to_string(tube).substr(0, 4), one, other});
    }
}

void add_many_equal(Cases& all, bool full) {
    const int n = full ? 10'000 : 150;
    HardMeshes copies = {"B05 identical triangles", copies_of_one_triangle(n),
                         copies_of_one_triangle(n)};
    copies.count = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    if (!full) {
        const auto count = static_cast<std::uint32_t>(n);
        copies.closed = copies.proper = first_with_all(count, count);
    }
    all.push_back(std::move(copies));

    const int blades = full ? 100'000 : 500;
    HardMeshes fans = {"B06 a fan and a probe at its hub", fan(blades),
                       one_triangle({0, 0, 0}, {1, 0, -1}, {0, 1, -1})};
    fans.closed = first_with_all(static_cast<std::uint32_t>(blades), 1);
    fans.proper = Pairs{};
    all.push_back(std::move(fans));
}

/// Triangles of width 2^-20 along the diagonals of a cube, or from face to face across them.
TestMesh slivers(int count, bool across) {
    std::uint64_t state = across ? 5 : 3;
    const auto draw = [&state] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state >> 41) * 0x1p-23;
    };
    TestMesh mesh;
    for (int i = 0; i < count; ++i) {
        const double y = draw() / 2, z = draw() / 2;
        const Double3 from = {0, y, z};
        const Double3 to = {1, y + draw() / 2, across ? 0.5 - z / 2 : z + draw() / 2};
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (Double3 p : {from, to, Double3{to.x, to.y + g, to.z + g}}) {
            if (across) std::swap(p.x, p.y);
            mesh.positions.push_back(p);
        }
        mesh.triangles.push_back({{base, base + 1, base + 2}});
    }
    return on_grid(std::move(mesh));
}

void add_awkward_sizes(Cases& all, bool full) {
    const TestMesh ball = on_grid(icosphere(full ? 8 : 3));
    all.push_back({"B07 one triangle through many", ball,
                   one_triangle({-9, -9, 0.25}, {9, -9, 0.5}, {0, 9, 0.75})});
    const int count = full ? 5'000 : 150;
    all.push_back({"B08 diagonal slivers", slivers(count, false), slivers(count, true)});

    const int steps = full ? 1'000 : 200;
    HardMeshes progression = {"B09 triangles at 2^-i", geometric_progression(steps),
                              geometric_progression(steps)};
    progression.closed = Pairs{};
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(steps); ++i) {
        progression.closed->push_back({i, i});
    }
    progression.proper = progression.closed;
    all.push_back(std::move(progression));

    const TestMesh small = icosphere(full ? 4 : 1);
    const TestMesh ring = torus(1, 0.25, full ? 64 : 12, full ? 32 : 6);
    const Double3 away = {1e6, -1e6, 1e6};
    all.push_back(
        {"B10 extent 1e-3 at 1e6", moved_by(small, 1e-3, away), moved_by(ring, 1e-3, away)});
    TestMesh flat_ball = small, flat_ring = ring;
    for (TestMesh* mesh : {&flat_ball, &flat_ring}) {
        for (Double3& p : mesh->positions) p.z *= 1e-30;
    }
    all.push_back({"B10 one axis 1e-30 wide", flat_ball, flat_ring});
}

void add_trivial(Cases& all) {
    const std::vector<std::pair<std::string, TestMesh>> meshes = {
        {"flat", grid_sheet(3, 2)},
        {"a point", one_triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0})},
        {"a segment", one_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2})},
        {"one triangle", one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})},
        {"nothing", {}}};
    for (const auto& [name, mesh] : meshes) {
        for (const auto& [other_name, other] : meshes) {
            all.push_back({"B11 " + name + " and " + other_name, mesh, other});
        }
    }
}

void add_cells(Cases& all, bool full) {
    all.push_back({"B12 a big triangle, small cells", on_grid(icosphere(full ? 5 : 3)),
                   one_triangle({10, 0.125, 0}, {-7, 9, 0.25}, {-7, -9, 0.1875})});
    const TestMesh planes = triangles_on_cell_planes();
    const TestMesh around = joined(planes, on_grid(fan(12)));
    all.push_back({"B13 on planes of cells", around, planes});
    HardMeshes turned = {"B13 on planes of cells, turned", around, planes};
    turned.placement = Placement::b_moves(by_rows({0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 1, 0}));
    all.push_back(std::move(turned));
    const TestMesh sheet = grid_sheet(8, 8);
    for (const double shift : {0.0, 0.5, 4.0}) {
        all.push_back({"B13 a sheet between cells, shift " + std::to_string(shift).substr(0, 3),
                       sheet, moved_by(sheet, 1, {shift, shift, 0})});
    }
}

void add_poses(Cases& all) {
    const TestMesh ball = on_grid(icosphere(1)), ring = on_grid(torus(1, 0.25, 12, 6));
    const auto add = [&](const std::string& name, const Placement& placement) {
        HardMeshes posed = {"B14 " + name, ball, ring};
        posed.placement = placement;
        all.push_back(std::move(posed));
    };
    const auto turn = [](double w, double x, double y, double z) {
        return Pose::from_quaternion(w, x, y, z, {0.25, 0.5, -0.125}).value();
    };
    add("a half turn", Placement::b_moves(turn(0, 1, 0, 0)));
    add("a half turn about a diagonal", Placement::b_moves(turn(0, 1, 1, 0)));
    add("w near 0", Placement::b_moves(turn(0x1p-60, 1, 2, 3)));
    add("far from unit length", Placement::b_moves(turn(1e-200, 2e-200, 3e-200, 4e-200)));
    add("both turned", Placement::world(turn(1e3, 2e3, -3e3, 1e3), turn(5, 1, 2, 3)));
    add("the relative pose", Placement::relative(turn(1, 2, 3, 4), turn(4, 3, 2, 1)));
}

void add_order(Cases& all, bool full) {
    const TestMesh ring = on_grid(torus(1, 0.5, full ? 60 : 20, full ? 30 : 10));
    all.push_back({"B15 order", ring, on_grid(moved_by(ring, 1, {0.5, 0.25, 0.125}))});
}

/// The overlaps of surfaces that are no solid's.
void add_no_solids(Cases& all, bool full) {
    const TestMesh cube = moved_by(unit_cube(), 1, {-0.5, -0.25, -0.125});
    all.push_back({"D05 three sheets on an edge", three_sheets(), cube});
    all.push_back({"D05 cubes that share an edge",
                   joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, 0})),
                   moved_by(unit_cube(), 1, {1, 0, 0.5})});
    all.push_back({"D05 cubes that share a vertex",
                   joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, 1})),
                   moved_by(unit_cube(), 1, {1, 0.5, 0})});
    const int n = full ? 8 : 1;
    all.push_back({"D06 a Moebius strip", moebius_strip(16 * n), on_grid(icosphere(full ? 3 : 1))});
    all.push_back({"D06 a Klein bottle", on_grid(klein_bottle(8 * n, 4 * n + 3)),
                   moved_by(cube, 2, {1, 0, 0})});
    all.push_back({"D07 a hemisphere", on_grid(upper_half(icosphere(full ? 4 : 2))),
                   moved_by(cube, 1, {0.5, 0, 0})});
}

}  // namespace

TestMesh triangles_on_cell_planes() {
    TestMesh planes;
    const auto add = [&](const Double3& p, const Double3& q, const Double3& r) {
        const auto first = static_cast<std::uint32_t>(planes.positions.size());
        for (const Double3& corner : {p, q, r}) planes.positions.push_back(corner);
        for (const Double3& corner : {p, q, r}) {
            planes.positions.push_back({-corner.x, -corner.y, -corner.z});
        }
        planes.triangles.push_back({{first, first + 1, first + 2}});
        planes.triangles.push_back({{first + 3, first + 4, first + 5}});
    };
    add({2, 0, 0}, {0, 2, 0}, {0, 0, 2});
    add({1, 1, 0}, {1, -1, 0}, {-1, 0, 0});  // holds the centre
    add({1, 0, 0}, {0, 1, 0}, {0, 0, 0});    // has a corner there
    add({1, 0, 0}, {2, 0, 0}, {3, 0, 0});    // a segment towards it
    add({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    add({0, 2, 1}, {0, -2, 1}, {0, 0, -2});  // in a plane of an axis, around it
    add({4, 4, 0}, {4, -4, 0}, {-4, 4, 0});
    return planes;
}

TestMesh on_grid(TestMesh mesh, double step) {
    for (Double3& p : mesh.positions) {
        p = {step * std::nearbyint(p.x / step), step * std::nearbyint(p.y / step),
             step * std::nearbyint(p.z / step)};
    }
    return mesh;
}

Cases hard_meshes(CaseSize size) {
    const bool full = size == CaseSize::full;
    Cases all;
    add_themselves(all, full);
    add_shells(all, full);
    add_sheets(all, full);
    add_tori(all, full);
    add_many_equal(all, full);
    add_awkward_sizes(all, full);
    add_trivial(all);
    add_cells(all, full);
    add_poses(all);
    add_order(all, full);
    add_no_solids(all, full);
    for (const HardPlacement& p : hard_placements()) {
        all.push_back({"F01 " + p.name, p.a, p.b, p.placement});
    }
    return all;
}

}  // namespace cdprep::test
