// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_points.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/small_hull.h"

namespace cdprep::test {
namespace {

// By hand: the faces come in order, and columns follow the next axis.
TEST(DirectionCell, IsKnownByHand) {
    EXPECT_EQ(direction_cell({1, -1, -1}), 0u);
    EXPECT_EQ(direction_cell({1, -0.7, -1}), 1u);
    EXPECT_EQ(direction_cell({1, -1, -0.7}), kDirectionCells);
    EXPECT_EQ(direction_cell({-1, 1, 1}), 2 * kDirectionCells * kDirectionCells - 1);
    EXPECT_EQ(direction_cell({0, 2, 0}), (2 * kDirectionCells + 4) * kDirectionCells + 4);
    EXPECT_EQ(direction_cell({0, 0, -3}), (5 * kDirectionCells + 4) * kDirectionCells + 4);
}

TEST(DirectionCell, IsOneOfThemWhateverTheDirection) {
    constexpr double kMost = std::numeric_limits<double>::max();
    constexpr double kLeast = std::numeric_limits<double>::denorm_min();
    for (const double x : {-kMost, -kLeast, 0.0, kLeast, 1.0, kMost}) {
        for (const double y : {-kMost, -1.0, 0.0, kLeast, kMost}) {
            for (const double z : {-kMost, 0.0, kLeast, 1.0}) {
                EXPECT_LT(direction_cell({x, y, z}), kDirectionStarts);
            }
        }
    }
}

TEST(DirectionCell, DoesNotDependOnTheLength) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 1000; ++i) {
        const Double3 d = {normal(random), normal(random), normal(random)};
        EXPECT_EQ(direction_cell(d), direction_cell({1024 * d.x, 1024 * d.y, 1024 * d.z}));
    }
}

TEST(ConvexPoints, AreFoundInTheirBlocks) {
    const SmallHull hull(box_corners(1, 2, 3));
    const ConvexPoints view = hull.view();
    ASSERT_EQ(view.count, 8u);
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(view.point(i), hull.points()[i]);
    EXPECT_EQ(view.reach, (Double3{1, 2, 3}));
}

}  // namespace
}  // namespace cdprep::test
