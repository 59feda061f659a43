// SPDX-License-Identifier: MIT
#include "cdprep/advanced/object_box.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "cdprep/motion.h"
#include "cdprep/pairs.h"
#include "scene/object_box.h"
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

bool holds(const WorldBox& box, const Double3& point, const Double3& origin) {
    const std::array<double, 3> p = {point.x - origin.x, point.y - origin.y, point.z - origin.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (p[axis] < box.lower[axis] || p[axis] > box.upper[axis]) return false;
    }
    return true;
}

// The swept box is around all vertices at all times. By chance, the box of one end is not.
TEST(ObjectBox, AroundAWayHoldsTheModelAtAllTimes) {
    const test::TestMesh cube = test::moved_by(test::unit_cube(), 1, {3, -2, 1});
    const test::OpenModel model = test::open_tiny(cube);
    std::mt19937 random(11);
    int outside = 0;
    for (int round = 0; round < 400; ++round) {
        const double far = round % 3 == 0 ? 1e7 : 0;
        const Double3 origin = {far, 0, -far};
        const double reach = round % 2 == 0 ? 0 : 0.25;
        const Pose start = shifted(test::random_pose(random, 2), {far, 0, -far});
        const Pose end = shifted(test::random_pose(random, 2), {far, 0, -far});
        const Motion motion = Motion::between(start, end, middle_of(model.model)).value();
        const RootBox from = root_box(model.model, start, reach);
        const RootBox to = root_box(model.model, end, reach);
        const WorldBox swept = world_box(swept_box(from, to), origin);
        const WorldBox of_end = world_box(to, origin);
        for (const double time : {0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0}) {
            const Pose at = motion.at(time);
            for (const Double3& vertex : cube.positions) {
                const Double3 p = transform_point(at, vertex);
                for (const double side : {-reach, reach}) {
                    ASSERT_TRUE(holds(swept, {p.x + side, p.y, p.z}, origin)) << round;
                    ASSERT_TRUE(holds(swept, {p.x, p.y + side, p.z}, origin)) << round;
                    ASSERT_TRUE(holds(swept, {p.x, p.y, p.z + side}, origin)) << round;
                }
                outside += holds(of_end, p, origin) ? 0 : 1;
            }
        }
    }
    EXPECT_GT(outside, 1000);
}

// The largest reach overflows: 0 times infinity is no number. Then the box is around all points.
TEST(ObjectBox, AroundMoreThanNumbersHoldIsEverything) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    const RootBox root = root_box(ball.model, {}, std::numeric_limits<double>::max());
    const WorldBox box = world_box(root, {});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(box.lower[axis], -std::numeric_limits<float>::infinity());
        EXPECT_EQ(box.upper[axis], std::numeric_limits<float>::infinity());
    }
    EXPECT_TRUE(may_meet(root, root_box(ball.model, {}, 0)));
}

TEST(ObjectBoxDeathTest, AReachThatIsNoLengthEndsTheProgram) {
    const test::OpenModel ball = test::open_tiny(test::icosphere(1));
    for (const double reach : {-1.0, -0x1p-1060, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_DEATH((void)root_box(ball.model, {}, reach), "The reach of a box must be finite");
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
