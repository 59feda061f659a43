// SPDX-License-Identifier: MIT
#include "decompose/enclose/merge_corners.h"

#include <gtest/gtest.h>

#include <vector>

#include "unit/tools/hull_flaw.h"

namespace cdprep::convex {
namespace {

/// A box of these sides, and beside each corner three points within `apart` of it.
std::vector<Double3> doubled_box(const Double3& size, double apart) {
    std::vector<Double3> points;
    for (unsigned k = 0; k < 8; ++k) {
        const Double3 corner = {(k & 1U) == 0 ? 0 : size.x, (k & 2U) == 0 ? 0 : size.y,
                                (k & 4U) == 0 ? 0 : size.z};
        points.push_back(corner);
        points.push_back({corner.x + ((k & 1U) == 0 ? -apart : apart), corner.y, corner.z});
        points.push_back({corner.x, corner.y + ((k & 2U) == 0 ? -apart : apart), corner.z});
        points.push_back({corner.x, corner.y, corner.z + ((k & 4U) == 0 ? -apart : apart)});
    }
    return points;
}

// 24 corners become the 8 of a box that holds them all, exactly, and is hardly larger: of a
// flat one, too, whose corners point along it.
TEST(MergeCorners, MakesOneOfEachGroupAndHoldsAll) {
    for (const double height : {1.0, 0.01}) {
        for (const double apart : {1e-15, 1e-11, 1e-9}) {
            const std::vector<Double3> points = doubled_box({1, 2, height}, apart);
            ASSERT_GT(convex_hull(points).points.size(), 8u) << apart;
            const ConvexHull merged = merge_corners(convex_hull(points), 1e-8);
            EXPECT_EQ(merged.points.size(), 8u) << height << " " << apart;
            for (const Double3& p : points) EXPECT_TRUE(test::holds(merged, p));
            for (const Double3& p : merged.points) {
                EXPECT_GE(p.z, -2e4 * apart);
                EXPECT_LE(p.z, height + 2e4 * apart);
            }
        }
    }
}

TEST(MergeCorners, LeavesCornersThatAreApart) {
    const ConvexHull hull = convex_hull(doubled_box({1, 2, 3}, 1e-3));
    const ConvexHull same = merge_corners(hull, 1e-4);
    EXPECT_EQ(same.points, hull.points);
    EXPECT_EQ(same.facets, hull.facets);
}

}  // namespace
}  // namespace cdprep::convex
