// SPDX-License-Identifier: MIT
#include "accuracy/bounding_shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "cdprep/pairs.h"
#include "study/memory_model.h"
#include "support/concave_solids.h"
#include "support/random_pose.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

Pose shifted(double x, double y = 0, double z = 0) {
    return Pose::from_quaternion(1, 0, 0, 0, {x, y, z}).value();
}

mesh::Mesh octahedron() {
    return test::mesh_of({{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                          {{{0, 2, 4},
                            {2, 1, 4},
                            {1, 3, 4},
                            {3, 0, 4},
                            {2, 0, 5},
                            {1, 2, 5},
                            {3, 1, 5},
                            {0, 3, 5}}}});
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

// Powers of two change exponents alone, and subnormal numbers little.
TEST(BoundingShapes, SpheresOfAnySizeAreThoseOfSizeOne) {
    const test::TestMesh prism = test::l_prism();
    const BoundingSphere plain = bounding_sphere(test::mesh_of(prism));
    for (const int exponent : {-1060, -1000, -600, 600, 999}) {
        const double size = std::ldexp(1.0, exponent);
        const BoundingSphere sphere =
            bounding_sphere(test::mesh_of(test::moved_by(prism, size, {})));
        EXPECT_NEAR(std::ldexp(sphere.radius, -exponent), plain.radius, 0.01) << exponent;
        EXPECT_NEAR(std::ldexp(sphere.centre.x, -exponent), plain.centre.x, 0.01) << exponent;
    }
}

// By hand: the smallest sphere around a right triangle has its longest side as diameter, and that
// around a corner of a cube goes through three of its points. Boxes have other middles.
TEST(BoundingShapes, SpheresComeNearTheSmallest) {
    const BoundingSphere triangle =
        bounding_sphere(test::mesh_of({{{0, 0, 0}, {4, 0, 0}, {0.5, 1, 0}}, {{{0, 1, 2}}}}));
    EXPECT_GE(triangle.radius, 2);
    EXPECT_LE(triangle.radius, 2 * 1.005);
    const double corner = std::sqrt(2.0 / 3);
    const BoundingSphere tip = bounding_sphere(
        test::mesh_of({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}, {{{0, 1, 2}}, {{0, 1, 3}}}}));
    EXPECT_GE(tip.radius, corner);
    EXPECT_LE(tip.radius, corner * 1.005);
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

// By hand: of the unit cube only the three pairs of faces cut, and its corners stay; the
// octahedron |x| + |y| + |z| <= 1 has six, as no other plane cuts any off.
TEST(BoundingShapes, PolytopesOfSimpleSolidsHaveTheirCorners) {
    EXPECT_EQ(bounding_dop(test::mesh_of(test::unit_cube())).corners.size(), 8U);
    const BoundingDop dop = bounding_dop(octahedron());
    ASSERT_EQ(dop.corners.size(), 6U);
    for (const Double3& p : dop.corners) {
        EXPECT_NEAR(std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z), 1, 1e-12);
        EXPECT_NEAR(p.x * p.x + p.y * p.y + p.z * p.z, 1, 1e-12);
    }
}

// By hand: octahedra corner to corner touch at a distance of 2; face to face, along the
// diagonal, at 2 / sqrt(3), where boxes around them meet up to 2.
TEST(BoundingShapes, PolytopesTellApartWhatBoxesDoNot) {
    const BoundingDop dop = bounding_dop(octahedron());
    const BoundingBox box = aligned_box(octahedron());
    EXPECT_TRUE(may_touch(dop, dop, shifted(2)));
    EXPECT_FALSE(may_touch(dop, dop, shifted(2.001)));
    EXPECT_TRUE(may_touch(dop, dop, shifted(0.66, 0.66, 0.66)));
    EXPECT_FALSE(may_touch(dop, dop, shifted(0.67, 0.67, 0.67)));
    EXPECT_TRUE(may_touch_aligned(box, box, shifted(0.67, 0.67, 0.67)));
    EXPECT_FALSE(may_touch(BoundingDop{}, dop, shifted(0)));
}

// Of models that touch, shapes around them do: exact answers against all three.
TEST(BoundingShapes, NeverMissAndOftenTellApart) {
    const test::TestMesh first = test::torus(1, 0.3, 16, 8);
    const test::TestMesh second = test::random_soup(5, 30, 0.5);
    const mesh::Mesh a = test::mesh_of(first);
    const mesh::Mesh b = test::mesh_of(second);
    const BoundingDop dop_a = bounding_dop(a);
    const BoundingDop dop_b = bounding_dop(b);
    const MemoryModel model_a = make_memory_model(a).value();
    const MemoryModel model_b = make_memory_model(b).value();
    Workspace workspace;
    std::mt19937 random(20261);
    int hits = 0;
    int apart = 0;
    std::array<int, 4> may = {};
    for (int i = 0; i < 2000; ++i) {
        const Pose pose = test::random_pose(random, 2.5);
        const bool by_sphere = may_touch(bounding_sphere(a), bounding_sphere(b), pose);
        const bool by_box = may_touch_aligned(aligned_box(a), aligned_box(b), pose);
        const bool by_oriented = may_touch(oriented_box(a), oriented_box(b), pose);
        const bool by_dop = may_touch(dop_a, dop_b, pose);
        apart += by_sphere && by_box && by_oriented && by_dop ? 0 : 1;
        may[0] += by_sphere ? 1 : 0;
        may[1] += by_box ? 1 : 0;
        may[2] += by_oriented ? 1 : 0;
        may[3] += by_dop ? 1 : 0;
        if (collide({model_a.model, model_b.model, Placement::b_moves(pose)}, workspace).hit !=
            Answer::yes) {
            continue;
        }
        ++hits;
        EXPECT_TRUE(by_sphere && by_box && by_oriented && by_dop);
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(apart, 300);
    EXPECT_EQ(may, (std::array{1563, 1800, 1549, 978})) << "recorded: what fits better parts more";
}

}  // namespace
}  // namespace cdprep::study
