// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/touched.h"

namespace cdprep::test {
namespace {

// By hand, 3-4-5: the nearest corner of the triangle is five away, its plane, an edge.
TEST(TouchingSphere, TangentTouches) {
    const TestMesh corner{{{3, 4, 0}, {9, 9, 0}, {9, 4, 0}}, {{{0, 1, 2}}}};
    const double less = std::nextafter(5.0, 0.0);
    EXPECT_EQ(touched(corner, Sphere{{0, 0, 0}, 5}).size(), 1u);
    EXPECT_TRUE(touched(corner, Sphere{{0, 0, 0}, less}).empty());
    const TestMesh face{{{-9, -9, 5}, {9, -9, 5}, {0, 9, 5}}, {{{0, 1, 2}}}};
    EXPECT_EQ(touched(face, Sphere{{0, 0, 0}, 5}).size(), 1u);
    EXPECT_TRUE(touched(face, Sphere{{0, 0, 0}, less}).empty());
    const TestMesh edge{{{3, 4, -9}, {3, 4, 9}, {9, 9, 0}}, {{{0, 1, 2}}}};
    EXPECT_EQ(touched(edge, Sphere{{0, 0, 0}, 5}).size(), 1u);
    EXPECT_TRUE(touched(edge, Sphere{{0, 0, 0}, less}).empty());
    // Tangent to a slanted plane: 2 x + 2 y + z = 9 is three from the origin.
    const TestMesh slanted{{{9, 0, -9}, {0, 9, -9}, {-9, -9, 45}}, {{{0, 1, 2}}}};
    EXPECT_EQ(touched(slanted, Sphere{{0, 0, 0}, 3}).size(), 1u);
    EXPECT_TRUE(touched(slanted, Sphere{{0, 0, 0}, std::nextafter(3.0, 0.0)}).empty());
}

TEST(TouchingSphere, RadiusNothingIsAPoint) {
    EXPECT_EQ(touched(unit_cube(), Sphere{{0, 0, 0}, 0}).empty(), false);
    EXPECT_TRUE(touched(unit_cube(), Sphere{{0, 0, -0x1p-1074}, 0}).empty());
    EXPECT_TRUE(touched(unit_cube(), Sphere{{0, 0, 0}, -1}).empty());
    EXPECT_TRUE(touched(unit_cube(), Sphere{{0, 0, 0}, std::nan("")}).empty());
    EXPECT_EQ(touched(unit_cube(), Sphere{{7, 0, 0}, kInfinity}), first_numbers(12));
    EXPECT_TRUE(touched({}, Sphere{{0, 0, 0}, 1}).empty());
}

// The surface counts, not the solid: a ball in the middle of the cube.
TEST(TouchingSphere, InsideIsNotTouching) {
    EXPECT_TRUE(touched(unit_cube(), Sphere{{0.5, 0.5, 0.5}, 0.49}).empty());
    EXPECT_EQ(touched(unit_cube(), Sphere{{0.5, 0.5, 0.5}, 0.5}), first_numbers(12));
}

// By symmetry: a moved model and a sphere moved back; whole numbers move exactly.
TEST(TouchingSphere, TheModelMayStandAnywhere) {
    const Pose world_from_model = Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, 10, 20, 30}).value();
    const TestMesh corner{{{3, 4, 0}, {9, 9, 0}, {9, 4, 0}}, {{{0, 1, 2}}}};
    const ShapeOptions moved{world_from_model};
    EXPECT_EQ(touched(corner, Sphere{{10, 20, 30}, 5}, moved).size(), 1u);
    EXPECT_TRUE(touched(corner, Sphere{{10, 20, 30}, std::nextafter(5.0, 0.0)}, moved).empty());
    EXPECT_TRUE(touched(corner, Sphere{{0, 0, 0}, 5}, moved).empty());
}

TEST(TouchingSphere, SizeDoesNotMatter) {
    for (const double scale : {0x1p-1074, 0x1p-1000, 0x1p-300, 0x1p300, 0x1p990}) {
        const TestMesh corner =
            moved_by({{{3, 4, 0}, {9, 9, 0}, {9, 4, 0}}, {{{0, 1, 2}}}}, scale, {0, 0, 0});
        EXPECT_EQ(touched(corner, Sphere{{0, 0, 0}, 5 * scale}).size(), 1u) << scale;
        const double less = std::nextafter(5 * scale, 0.0);
        EXPECT_TRUE(touched(corner, Sphere{{0, 0, 0}, less}).empty()) << scale;
    }
    // A huge sphere through the origin: every triangle of the tiny cube has that corner
    // or one inside.
    const TestMesh tiny = moved_by(unit_cube(), 0x1p-1000, {0, 0, 0});
    EXPECT_EQ(touched(tiny, Sphere{{1e300, 0, 0}, 1e300}), first_numbers(12));
    EXPECT_TRUE(touched(tiny, Sphere{{1e300, 0, 0}, std::nextafter(1e300, 0.0)}).empty());
}

}  // namespace
}  // namespace cdprep::test
