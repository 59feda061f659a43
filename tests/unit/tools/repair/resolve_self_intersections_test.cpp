// SPDX-License-Identifier: MIT
#include "repair/repair_steps.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "repair/stored_verdict.h"
#include "unit/tools/repair_mesh_of.h"

namespace cdprep::mesh {
namespace {

using test::repair_mesh_of;
using test::TestMesh;

TestMesh wide_cube() {
    TestMesh cube = test::unit_cube();
    for (Double3& p : cube.positions) p = {2 * p.x - 1, 2 * p.y - 1, 2 * p.z - 1};
    return cube;
}

/// With a corner on each side of wide_cube().
TestMesh octahedron(const std::array<Double3, 6>& corners) {
    TestMesh made;
    made.positions.assign(corners.begin(), corners.end());
    made.triangles = {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}},
                      {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}};
    return made;
}

double volume_of(const RepairMesh& mesh) {
    return find_stored_verdict(mesh.positions, mesh.triangles).verdict.volume;
}

// All corners of the octahedron touch the cube, so only points of its edges tell where it lies.
TEST(ResolveSelfIntersections, APartThatTouchesWithAllItsCornersIsInside) {
    const TestMesh inner =
        octahedron({{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}});
    const Stepped done =
        resolve_self_intersections(repair_mesh_of(test::joined(wide_cube(), inner)), {}, {});
    EXPECT_TRUE(done.report.refused.empty());
    EXPECT_EQ(done.report.dropped.size(), 8U);
    EXPECT_EQ(volume_of(done.mesh), 8.0);
}

// The middles of its edges are no doubles, so no point of it is known to be off the cube.
TEST(ResolveSelfIntersections, APartOfWhichNoPointIsKnownToBeOffTheOthersIsRefused) {
    const double a = 1.0 / 3, b = 1.0 / 7, c = 1.0 / 31, d = 1.0 / 73;
    const TestMesh inner =
        octahedron({{{1, a, -b}, {-1, c, d}, {c, 1, a}, {-d, -1, c}, {a, -d, 1}, {b, -c, -1}}});
    const TestMesh both = test::joined(wide_cube(), inner);
    const Stepped done = resolve_self_intersections(repair_mesh_of(both), {}, {});
    ASSERT_EQ(done.report.refused.size(), 1U);
    EXPECT_NE(done.report.refused[0].sentence.find("touches others at every point"),
              std::string::npos)
        << done.report.refused[0].sentence;
    EXPECT_EQ(done.mesh.triangles, both.triangles);
}

// By hand: half of the small box sticks out, 1/16 of the cube. The cube's second corner is moved
// by less than any rounding of a difference shows.
TEST(ResolveSelfIntersections, TheOutsideIsFoundExactly) {
    TestMesh cube;
    cube.positions = {{0, 5, 0}, {1e-17, 5, 1}, {1, 5, 0}, {0, 6, 1},
                      {0, 6, 0}, {1, 5, 1},     {1, 6, 0}, {1, 6, 1}};
    cube.triangles = {{{0, 1, 3}}, {{0, 3, 4}}, {{2, 6, 7}}, {{2, 7, 5}}, {{0, 2, 5}}, {{0, 5, 1}},
                      {{4, 3, 7}}, {{4, 7, 6}}, {{0, 4, 6}}, {{0, 6, 2}}, {{1, 5, 7}}, {{1, 7, 3}}};
    const TestMesh box = test::moved_by(test::unit_cube(), 0.5, {0.75, 5.25, 0.25});
    const Stepped done =
        resolve_self_intersections(repair_mesh_of(test::joined(cube, box)), {}, {});
    EXPECT_TRUE(done.report.refused.empty());
    EXPECT_EQ(volume_of(done.mesh), 1.0625);
    EXPECT_EQ(done.mesh.triangles.size(), 36U);
}

}  // namespace
}  // namespace cdprep::mesh
