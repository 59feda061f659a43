// SPDX-License-Identifier: MIT
#include "cdprep/advanced/object_box.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "cdprep/pairs.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep {
namespace {

bool meet(const WorldBox& a, const WorldBox& b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
    }
    return true;
}

Pose shifted(const Pose& pose, const Double3& by) {
    const auto& r = pose.rotation();
    const Double3& t = pose.translation();
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x + by.x,
                            t.y + by.y, t.z + by.z})
        .value();
}

// The law of broad phases: what is near has boxes that meet. Counts show that neither test is idle.
TEST(ObjectBox, BoxesOfModelsThatAreNearMeet) {
    const test::OpenModel bar = test::open_tiny(test::torus(1, 0.1, 12, 6));
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    std::mt19937 random(7);
    int near = 0, apart = 0, apart_by_turned = 0;
    Workspace workspace;
    for (int round = 0; round < 3000; ++round) {
        const double far = round % 3 == 0 ? 1e7 : 0;
        const Double3 origin = {far, round % 2 == 0 ? 0.0 : 3.0, -far};
        const Pose a = shifted(test::random_pose(random, 2), {far, 0, -far}),
                   b = shifted(test::random_pose(random, 2), {far, 0, -far});
        const double d = std::uniform_real_distribution<double>(0, 1)(random);
        const Pair pair{bar.model, round % 2 == 0 ? bar.model : ball.model, Placement::world(a, b)};
        const RootBox root_a = root_box(pair.a, a, d / 2), root_b = root_box(pair.b, b, d / 2);
        const bool meets = meet(world_box(root_a, origin), world_box(root_b, origin));
        if (distance(pair, workspace, {.max_distance = d})) {
            ++near;
            ASSERT_TRUE(meets && may_meet(root_a, root_b)) << round;
        } else if (!meets) {
            ++apart;
        } else if (!may_meet(root_a, root_b)) {
            ++apart_by_turned;
        }
    }
    EXPECT_GT(near, 600);
    EXPECT_GT(apart, 200);
    EXPECT_GT(apart_by_turned, 100);
}

TEST(ObjectBoxDeathTest, AReachThatIsNoLengthEndsTheProgram) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    for (const double reach : {-1.0, -0x1p-1060, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_DEATH((void)root_box(ball.model, {}, reach),
                     "The reach of a box is a finite number");
    }
    const test::AlignedBytes bytes =
        test::bake_tiny(test::icosphere(1).positions, test::icosphere(1).triangles);
    const auto blind = Model::open(bytes.span(), {SectionId::triangles});
    ASSERT_TRUE(blind);
    EXPECT_DEATH((void)root_box(blind.value(), {}, 0), "The box of a model needs its BVH");
}

TEST(ObjectBox, OfNoTrianglesIsAbsent) {
    const test::OpenModel empty = test::open_tiny(test::TestMesh{});
    const WorldBox box = world_box(root_box(empty.model, {}, 1));
    EXPECT_GT(box.lower[0], box.upper[0]);
}

}  // namespace
}  // namespace cdprep
