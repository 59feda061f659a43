// SPDX-License-Identifier: MIT
#include "repair/repair_steps.h"

#include <gtest/gtest.h>

#include "unit/tools/repair_mesh_of.h"

namespace cdprep::mesh {
namespace {

using test::TestMesh;

/// A cube from -1 to 1 with a tetrahedral cavity that touches its top with vertex `touching`.
TestMesh with_touching_cavity(std::uint32_t touching) {
    TestMesh cube = test::unit_cube();
    for (Double3& p : cube.positions) p = {2 * p.x - 1, 2 * p.y - 1, 2 * p.z - 1};
    TestMesh cavity;
    cavity.positions = {{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}};
    cavity.triangles = {{{0, 1, 2}}, {{0, 3, 1}}, {{1, 3, 2}}, {{2, 3, 0}}};
    cavity.positions[touching].z = 1;
    if (touching == 0) cavity = test::reversed(cavity);  // it was moved through the others' plane
    return test::joined(cube, cavity);
}

TEST(OrientOutward, ACavityThatTouchesTheOuterWallStaysInsideOut) {
    for (const std::uint32_t touching : {0U, 3U}) {
        const TestMesh mesh = with_touching_cavity(touching);
        const Stepped done = orient_outward(test::repair_mesh_of(mesh));
        EXPECT_TRUE(done.report.reversed.empty()) << touching;
        EXPECT_EQ(done.mesh.triangles, mesh.triangles);
    }
}

/// The cube from 0 to 1, and inside out a box through it with square ends on two of its sides.
TestMesh with_tunnel(double from, double to) {
    TestMesh tunnel = test::unit_cube();
    for (Double3& p : tunnel.positions) {
        p.y = from + p.y * (to - from);
        p.z = from + p.z * (to - from);
    }
    return test::joined(test::unit_cube(), test::reversed(tunnel));
}

// Only the middles of edges tell that it lies inside.
TEST(OrientOutward, ACavityWhoseVerticesAllLieOnTheOuterWallStaysInsideOut) {
    const TestMesh mesh = with_tunnel(0.251, 0.751);
    const Stepped done = orient_outward(test::repair_mesh_of(mesh));
    EXPECT_TRUE(done.report.reversed.empty());
    EXPECT_TRUE(done.report.refused.empty());
    EXPECT_EQ(done.mesh.triangles, mesh.triangles);
}

TEST(OrientOutward, AComponentThatTouchesAnotherAtEveryPointIsRefused) {
    const TestMesh mesh = with_tunnel(0, 1);
    const Stepped done = orient_outward(test::repair_mesh_of(mesh));
    EXPECT_TRUE(done.report.reversed.empty());
    EXPECT_EQ(done.mesh.triangles, mesh.triangles);
    ASSERT_EQ(done.report.refused.size(), 1U);
    const Refusal& refusal = done.report.refused[0];
    EXPECT_EQ(refusal.sentence,
              "the component of triangle 12 touches that of triangle 0 at every point that was "
              "tested, so it may be a cavity.");
    EXPECT_EQ(refusal.triangles, (std::vector<std::uint32_t>{12, 0}));
}

// Its box fills that of the other, and it lies outside.
TEST(OrientOutward, APartOutsideAnotherOfTheSameBoxIsTurned) {
    TestMesh corner;
    corner.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    corner.triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}};
    TestMesh other = test::reversed(corner);
    for (Double3& p : other.positions) p = {1 - p.x, 1 - p.y, 1 - p.z};
    other = test::reversed(other);
    const Stepped done = orient_outward(test::repair_mesh_of(test::joined(corner, other)));
    EXPECT_EQ(done.report.reversed.size(), 4U);
    EXPECT_EQ(done.report.reversed[0], 4U);
}

}  // namespace
}  // namespace cdprep::mesh
