// SPDX-License-Identifier: MIT
#include "study/bounding_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cdprep/collide.h"
#include "study/memory_model.h"
#include "support/random_pose.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

Pose shifted(double x, double y = 0, double z = 0) {
    return Pose::from_quaternion(1, 0, 0, 0, {x, y, z}).value();
}

// By hand: the sphere around the unit cube has its corners on it.
TEST(BoundingShapes, OfAUnitCubeAreKnown) {
    const mesh::Mesh cube = test::mesh_of(test::unit_cube());
    const BoundingSphere sphere = bounding_sphere(cube);
    EXPECT_GE(sphere.radius, std::sqrt(0.75));
    EXPECT_NEAR(sphere.radius, std::sqrt(0.75), 1e-12);
    const BoundingBox box = aligned_box(cube);
    EXPECT_EQ(box.half, (Double3{0.5, 0.5, 0.5}));
    EXPECT_TRUE(may_touch_aligned(box, box, shifted(1)));
    EXPECT_FALSE(may_touch_aligned(box, box, shifted(1.001)));
    EXPECT_TRUE(may_touch(sphere, sphere, shifted(std::sqrt(3.0))));
    EXPECT_FALSE(may_touch(sphere, sphere, shifted(1.75)));
}

// By hand: cubes turned by 45 degrees, an edge towards an edge across: boxes along their own
// axes part them where the boxes around them meet.
TEST(BoundingShapes, OrientedBoxesTellTurnedCubesApart) {
    const BoundingBox box = aligned_box(test::mesh_of(test::unit_cube()));
    const double angle = std::acos(-1.0) / 8;
    const Pose turned =
        Pose::from_quaternion(std::cos(angle), 0, 0, std::sin(angle), {1.7, 0.8, 0}).value();
    EXPECT_TRUE(may_touch_aligned(box, box, turned));
    EXPECT_FALSE(may_touch(box, box, turned));
}

// Of models that touch, shapes around them do: exact answers against all three.
TEST(BoundingShapes, NeverMissAndOftenTellApart) {
    const test::TestMesh first = test::torus(1, 0.3, 16, 8);
    const test::TestMesh second = test::random_soup(5, 30, 0.5);
    const mesh::Mesh a = test::mesh_of(first);
    const mesh::Mesh b = test::mesh_of(second);
    const MemoryModel model_a = make_memory_model(a).value();
    const MemoryModel model_b = make_memory_model(b).value();
    Workspace workspace;
    std::mt19937 random(20261);
    int hits = 0;
    int apart = 0;
    for (int i = 0; i < 2000; ++i) {
        const Pose pose = test::random_pose(random, 2.5);
        const bool by_sphere = may_touch(bounding_sphere(a), bounding_sphere(b), pose);
        const bool by_box = may_touch_aligned(aligned_box(a), aligned_box(b), pose);
        const bool by_oriented = may_touch(oriented_box(a), oriented_box(b), pose);
        apart += by_sphere && by_box && by_oriented ? 0 : 1;
        if (!collide(model_a.model, model_b.model, Placement::b_moves(pose), workspace).hit) {
            continue;
        }
        ++hits;
        EXPECT_TRUE(by_sphere && by_box && by_oriented);
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(apart, 300);
}

}  // namespace
}  // namespace cdprep::study
