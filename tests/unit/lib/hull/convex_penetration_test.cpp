// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_penetration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/hull_pairs.h"
#include "support/placements.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

// By hand: half a unit of two boxes in common along x; B leaves along +x.
TEST(ConvexPenetration, TakesBOutOfA) {
    const SmallHull box(box_corners(1, 1, 1));
    const auto found = convex_penetration(box.view(), box.view(), shifted({1.5, 0.25, 0}));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->upper, 0.5, 1e-15);
    EXPECT_NEAR(found->lower, 0.5, 1e-14);
    EXPECT_DOUBLE_EQ(found->normal.x, 1);
    EXPECT_DOUBLE_EQ(found->witness_a.x, 1);
    EXPECT_DOUBLE_EQ(found->witness_b.x, 0.5);
    EXPECT_FALSE(convex_penetration(box.view(), box.view(), shifted({2.5, 0, 0})));
}

TEST(ConvexPenetration, HullsThatOnlyTouchAreInContact) {
    const SmallHull box(box_corners(1, 1, 1));
    const auto faces = convex_penetration(box.view(), box.view(), shifted({0, 0.5, 2}));
    ASSERT_TRUE(faces);
    EXPECT_EQ(faces->lower, 0);
    EXPECT_LE(faces->upper, 1e-14);
    EXPECT_NEAR(faces->normal.z, 1, 1e-15);
    EXPECT_TRUE(convex_penetration(box.view(), box.view(), shifted({2, 2, 2})));
}

// By symmetry: a point, a segment and a square across each other have no depth.
TEST(ConvexPenetration, OfFlatHullsIsZero) {
    const SmallHull point(Points{{0, 0, 0}});
    const SmallHull segment(Points{{-1, 0, 0}, {1, 0, 0}});
    const SmallHull square(Points{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    for (const SmallHull* a : {&point, &segment, &square}) {
        for (const SmallHull* b : {&point, &segment, &square}) {
            const auto found = convex_penetration(a->view(), b->view(), shifted({}));
            ASSERT_TRUE(found);
            EXPECT_EQ(found->lower, 0);
            EXPECT_LE(found->upper, 1e-14);
            const Double3& n = found->normal;
            EXPECT_NEAR(std::hypot(n.x, n.y, n.z), 1, 1e-15);
        }
    }
}

TEST(ConvexPenetration, PermittedErrorsAreKeptAndSaveSteps) {
    std::mt19937 random(8);
    std::normal_distribution<double> normal;
    Points points(500);
    for (Double3& p : points) {
        p = {normal(random), normal(random), normal(random)};
        const double length = std::hypot(p.x, p.y, p.z);
        p = {p.x / length, p.y / length, p.z / length};
    }
    const SmallHull ball(points);
    QueryCounts rough, fine;
    for (int i = 0; i < 50; ++i) {
        const Placement placement = Placement::b_moves(random_pose(random, 0.9));
        const auto best =
            convex_penetration(ball.view(), ball.view(), placement, {}, nullptr, &fine);
        const auto near = convex_penetration(ball.view(), ball.view(), placement,
                                             {.relative_error = 0.1}, nullptr, &rough);
        ASSERT_TRUE(best && near);
        EXPECT_LE(best->upper - best->lower, 1e-13);
        EXPECT_LE(near->upper - near->lower, 0.1 * near->upper);
        EXPECT_LE(near->lower, best->upper);
        EXPECT_GE(near->upper, best->lower);
    }
    EXPECT_LT(rough.hull_steps, fine.hull_steps);
}

// By what the answer means: so far along the normal and a little farther B is free, and
// a little less far it is not.
TEST(ConvexPenetration, TheWayOutLeadsOut) {
    std::mt19937 random(9);
    int deep = 0;
    for (int i = 0; i < 1500; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = fine_pair(random);
        const SmallHull a(pair.a), b(pair.b);
        const auto found = convex_penetration(a.view(), b.view(), Placement::b_moves(pair.pose));
        if (!found) continue;
        const auto moved_by = [&](double way) {
            const Double3& t = pair.pose.translation();
            const Double3& n = found->normal;
            return Placement::b_moves(
                pose_of(pair.pose.rotation(), {t.x + way * n.x, t.y + way * n.y, t.z + way * n.z}));
        };
        EXPECT_FALSE(convex_collide(a.view(), b.view(), moved_by(found->upper + 1e-14)));
        if (found->lower < 1e-13) continue;
        ++deep;
        EXPECT_TRUE(convex_collide(a.view(), b.view(), moved_by(found->lower - 1e-13)));
    }
    EXPECT_GT(deep, 50);
}

}  // namespace
}  // namespace cdprep::test
