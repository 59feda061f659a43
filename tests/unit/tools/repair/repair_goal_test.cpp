// SPDX-License-Identifier: MIT
#include "repair/repair_goal.h"

#include <gtest/gtest.h>

#include "crossings/self_intersections.h"
#include "mesh/weld.h"
#include "repair/repair.h"
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
    const SelfCrossing crossing = find_self_crossing(soup_of(mesh));
    return missed_goal(preset, find_stored_verdict(mesh.positions, mesh.triangles), crossing,
                       crossing);
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
    const std::vector<TriangleMeeting> meetings = find_self_intersections(test::welded(cubes));
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
    const std::vector<TriangleMeeting> meetings = find_self_intersections(test::welded(cubes));
    const SelfCrossing crossing = find_self_crossing(soup_of(cubes));
    EXPECT_EQ(crossing.pairs, meetings.size());
    EXPECT_EQ(crossing.first, meetings[0].a);
    EXPECT_EQ(crossing.second, meetings[0].b);
}

/// Not repaired: what came of each triangle is given by hand.
RepairMesh output_of(const TestMesh& mesh, const std::vector<std::uint32_t>& sources) {
    RepairMesh output;
    output.positions = mesh.positions;
    output.triangles = mesh.triangles;
    for (const std::uint32_t source : sources) output.triangle_origin.push_back({source, {}});
    return output;
}

/// A large triangle in the plane z = 0, and a small one through its middle.
TestMesh crossing_triangles() {
    return {{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {1, 2, -1}, {1, 2, 1}, {3, 2, 0}},
            {{{0, 1, 2}}, {{3, 4, 5}}}};
}

// One pair. The large triangle cut along y = 2 and above it: three fragments that touch the
// small one are still one pair.
TEST(RepairGoal, FragmentsOfATriangleCountAsOne) {
    const TestMesh whole = crossing_triangles();
    TestMesh cut = whole;
    cut.positions.insert(cut.positions.end(), {{0, 2, 0}, {6, 2, 0}});
    cut.triangles = {{{0, 1, 7}}, {{3, 4, 5}}, {{0, 7, 6}}, {{6, 7, 2}}};
    const SelfCrossing before = find_self_crossing(soup_of(whole));
    EXPECT_EQ(before.pairs, 1U);
    EXPECT_EQ(before.apart, 1U);
    const RepairMesh fragments = output_of(cut, {0, 1, 0, 0});
    const SelfCrossing after = find_output_crossing(soup_of(whole), fragments);
    EXPECT_GE(after.pairs, 2U);
    EXPECT_EQ(after.apart, 1U);
    EXPECT_EQ(worse_crossing(before, after), "");
    // As new triangles they are pairs of their own.
    const RepairMesh made = output_of(cut, {kNone, 1, kNone, kNone});
    const SelfCrossing as_new = find_output_crossing(soup_of(whole), made);
    EXPECT_EQ(as_new.pairs, after.pairs);
    EXPECT_EQ(as_new.apart, after.pairs);
    EXPECT_NE(worse_crossing(before, as_new), "");
}

// Fragments of neighbours that touch where the triangles did touch nothing worse.
TEST(RepairGoal, FragmentsOfNeighboursAreNoPair) {
    const TestMesh whole = {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 1}},
                            {{{0, 1, 2}}, {{2, 1, 3}}}};
    TestMesh cut = whole;
    cut.positions.push_back({1, 1, 0});
    cut.triangles = {{{0, 1, 4}}, {{2, 1, 3}}, {{0, 4, 2}}};
    const SelfCrossing after = find_output_crossing(soup_of(whole), output_of(cut, {0, 1, 0}));
    EXPECT_EQ(after.apart, 0U);
    EXPECT_EQ(find_self_crossing(soup_of(whole)).pairs, 0U);
}

// A triangle and its copy through another are one pair more than the copies are.
TEST(RepairGoal, CopiesOfATriangleCountAsOne) {
    TestMesh mesh = crossing_triangles();
    mesh.triangles.push_back(mesh.triangles[0]);
    const SelfCrossing crossing = find_self_crossing(soup_of(mesh));
    EXPECT_EQ(crossing.pairs, 3U);
    EXPECT_EQ(crossing.apart, 1U);
    const SelfCrossing as_output = find_output_crossing(soup_of(mesh), output_of(mesh, {0, 1, 2}));
    EXPECT_EQ(as_output.pairs, 3U);
    EXPECT_EQ(as_output.apart, 1U);
    // Also when a fragment is all that is left of the copy.
    TestMesh cut = mesh;
    cut.positions.push_back({0, 4, 0});
    cut.triangles[2] = {{0, 1, 6}};
    const SelfCrossing as_fragment = find_output_crossing(soup_of(mesh), output_of(cut, {0, 1, 2}));
    EXPECT_EQ(as_fragment.pairs, 3U);
    EXPECT_EQ(as_fragment.apart, 1U);
}

TEST(RepairGoal, MoreCrossingsThanBeforeAreNoGoal) {
    const TestMesh cube = unit_cube();
    const StoredVerdict closed = find_stored_verdict(cube.positions, cube.triangles);
    SelfCrossing none, some, more;
    some.pairs = some.apart = 3;
    more.pairs = more.apart = 5;
    for (const char* preset : {"safe", "closed"}) {
        EXPECT_EQ(missed_goal(preset, closed, some, some), "");
        EXPECT_EQ(missed_goal(preset, closed, more, some), "");
        EXPECT_EQ(
            missed_goal(preset, closed, some, more),
            "worse than the input: 5 pairs of triangles cross or touch, compared with 3 before; "
            "the fragments of a triangle count as one");
        EXPECT_EQ(missed_goal(preset, closed, none, some),
                  "worse than the input: 3 pairs of triangles cross or touch, compared with none "
                  "before; the fragments of a triangle count as one");
        // Of an input that was not examined to the end nothing is known.
        some.is_complete = false;
        EXPECT_EQ(missed_goal(preset, closed, some, more), "");
        some.is_complete = true;
    }
    none.is_complete = false;
    EXPECT_EQ(missed_goal("solid", closed, some, none),
              "not solid: not all pairs of triangles were examined for crossings");
}

TEST(RepairGoal, ALimitIsSaid) {
    TestMesh mesh;
    for (int i = 0; i < 100; ++i)
        mesh = joined(mesh, moved_by(crossing_cubes(), 1, {3.0 * i, 0, 0}));
    const SelfCrossing all = find_self_crossing(soup_of(mesh));
    EXPECT_TRUE(all.is_complete);
    SearchOptions options;
    options.limits.pairs = 10;
    const SelfCrossing some = find_self_crossing(soup_of(mesh), options);
    EXPECT_FALSE(some.is_complete);
    EXPECT_GE(some.pairs, 10U);
    EXPECT_LT(some.pairs, all.pairs);
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
