// SPDX-License-Identifier: MIT
#include "mesh/repair_goal.h"

#include <gtest/gtest.h>

#include "mesh/repair.h"
#include "mesh/self_intersections.h"
#include "mesh/weld.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

using test::joined;
using test::moved_by;
using test::soup_of;
using test::TestMesh;
using test::unit_cube;

/// What `preset` lacks of the mesh as it is, and of the mesh it makes.
std::string missed_by(const TestMesh& mesh, const char* preset) {
    return missed_goal(preset, find_stored_verdict(mesh.positions, mesh.triangles),
                       find_self_crossing(soup_of(mesh)));
}

TestMesh crossing_cubes() {
    return joined(unit_cube(), moved_by(unit_cube(), 1, {0.5, 0.25, 0.125}));
}

TEST(RepairGoal, ACubeIsAllThatIsPromised) {
    for (const char* preset : {"safe", "closed", "solid"}) {
        EXPECT_EQ(missed_by(unit_cube(), preset), "") << preset;
    }
}

TEST(RepairGoal, AnOpenCubeIsSafeAndNotClosed) {
    TestMesh open = unit_cube();
    open.triangles.pop_back();
    EXPECT_EQ(missed_by(open, "safe"), "");
    EXPECT_EQ(missed_by(open, "closed"), "not closed: 3 edges are still open");
    EXPECT_EQ(missed_by(open, "solid"), "not solid: 3 edges are still open");
}

TEST(RepairGoal, OneTurnedTriangleIsNotOriented) {
    TestMesh cube = unit_cube();
    std::swap(cube.triangles[4].vertex[0], cube.triangles[4].vertex[1]);
    EXPECT_EQ(missed_by(cube, "safe"), "not safe: 3 edges have triangles wound differently");
}

// A triangle on an edge of the cube: that edge has three.
TEST(RepairGoal, AFinIsNotManifold) {
    TestMesh cube = unit_cube();
    const auto apex = static_cast<std::uint32_t>(cube.positions.size());
    cube.positions.push_back({-1, -1, -1});
    cube.triangles.push_back({{cube.triangles[0].vertex[0], cube.triangles[0].vertex[1], apex}});
    EXPECT_EQ(missed_by(cube, "safe"), "not safe: 1 edge has more than two triangles");
}

TEST(RepairGoal, CrossingCubesAreClosedAndNotSolid) {
    const TestMesh cubes = crossing_cubes();
    EXPECT_EQ(missed_by(cubes, "closed"), "");
    const std::vector<TriangleMeeting> meetings =
        find_self_intersections(weld(soup_of(cubes)).mesh);
    ASSERT_FALSE(meetings.empty());
    EXPECT_EQ(missed_by(cubes, "solid"), "not solid: " + std::to_string(meetings.size()) +
                                             " pairs of triangles still cross or touch; first " +
                                             std::to_string(meetings[0].a) + " and " +
                                             std::to_string(meetings[0].b));
}

// Of nothing every promise is kept, and means nothing.
TEST(RepairGoal, NoTrianglesReachNoGoal) {
    for (const char* preset : {"safe", "closed", "solid"}) {
        EXPECT_NE(missed_by({{{1, 2, 3}}, {}}, preset).find("there are no triangles"),
                  std::string::npos);
    }
}

// Copies are counted as if every pair had been listed.
TEST(RepairGoal, CopiesCountAsPairs) {
    TestMesh cubes = crossing_cubes();
    const std::vector<Triangle> once = cubes.triangles;
    for (const std::size_t copied : {0U, 0U, 5U, 13U, 20U}) {
        cubes.triangles.insert(cubes.triangles.begin() + 3, once[copied]);
    }
    const std::vector<TriangleMeeting> meetings =
        find_self_intersections(weld(soup_of(cubes)).mesh);
    const SelfCrossing crossing = find_self_crossing(soup_of(cubes));
    EXPECT_EQ(crossing.pairs, meetings.size());
    EXPECT_EQ(crossing.first, meetings[0].a);
    EXPECT_EQ(crossing.second, meetings[0].b);
}

// Numbers are those of the soup, with what is left out counted.
TEST(RepairGoal, TrianglesWithoutPlaceKeepTheirNumbers) {
    TestMesh cubes = crossing_cubes();
    const SelfCrossing before = find_self_crossing(soup_of(cubes));
    cubes.triangles.insert(cubes.triangles.begin(), {{0, 0, 1}});
    const SelfCrossing after = find_self_crossing(soup_of(cubes));
    EXPECT_EQ(after.pairs, before.pairs);
    EXPECT_EQ(after.first, before.first + 1);
    EXPECT_EQ(after.second, before.second + 1);
}

}  // namespace
}  // namespace cdprep::mesh
