// SPDX-License-Identifier: MIT
#include "accuracy/ladders.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

// By hand: on 2^1 planes an axis, all goes to a corner of the cube; its corners stay.
TEST(OnGrid, OneBitKeepsTheCornersOfTheCube) {
    const mesh::Mesh cube = test::mesh_of(test::unit_cube());
    EXPECT_EQ(on_grid(cube, 1).positions, cube.positions);
}

// A vertex goes to the nearest plane along each axis: half a step at most.
TEST(OnGrid, MovesByHalfAStepAtMost) {
    const mesh::Mesh ball = test::mesh_of(test::icosphere(3));
    const mesh::Mesh stored = on_grid(ball, 16);
    const double half = 0.5 * 2 / 65535 * (1 + 1e-9);
    double most = 0;
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        const Double3& p = ball.positions[i];
        const Double3& q = stored.positions[i];
        most = std::max({most, std::fabs(p.x - q.x), std::fabs(p.y - q.y), std::fabs(p.z - q.z)});
    }
    EXPECT_LE(most, half);
    EXPECT_GT(most, half / 2);
    EXPECT_EQ(stored.triangles, ball.triangles);
}

TEST(FitsFloat, LeavesRoomToMove) {
    mesh::Mesh point;
    point.positions = {{0, -0x1p120, 0}};
    EXPECT_TRUE(fits_float(point));
    point.positions = {{0, -0x1p121, 0}};
    EXPECT_FALSE(fits_float(point));
}

TEST(OnGrid, TakesWhatHasNoExtent) {
    EXPECT_TRUE(on_grid({}, 16).positions.empty());
    mesh::Mesh point;
    point.positions = {{1, 2, 3}};
    EXPECT_EQ(on_grid(point, 16).positions, point.positions);
}

}  // namespace
}  // namespace cdprep::study
