// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/touched.h"

namespace cdprep::test {
namespace {

/// Corners (3, 4, -9), (3, 4, 9), (9, 9, 0).
TestMesh upright() {
    return {{{3, 4, -9}, {3, 4, 9}, {9, 9, 0}}, {{{0, 1, 2}}}};
}

// By hand, 3-4-5: the side along the edge, an end at the edge.
TEST(TouchingCapsule, TangentTouches) {
    const double less = std::nextafter(5.0, 0.0);
    const Double3 low = {0, 0, -1}, high = {0, 0, 1};
    EXPECT_EQ(touched(upright(), Capsule{low, high, 5}).size(), 1u);
    EXPECT_TRUE(touched(upright(), Capsule{low, high, less}).empty());
    EXPECT_EQ(touched(upright(), Capsule{{-9, 0, 0}, {0, 0, 0}, 5}).size(), 1u);
    EXPECT_TRUE(touched(upright(), Capsule{{-9, 0, 0}, {0, 0, 0}, less}).empty());
    // Crossing edges, five apart along z.
    const TestMesh edge{{{-9, 0, 5}, {9, 0, 5}, {0, 0, 20}}, {{{0, 1, 2}}}};
    EXPECT_EQ(touched(edge, Capsule{{0, -3, 0}, {0, 7, 0}, 5}).size(), 1u);
    EXPECT_TRUE(touched(edge, Capsule{{0, -3, 0}, {0, 7, 0}, less}).empty());
}

TEST(TouchingCapsule, WithoutLengthItIsASphere) {
    EXPECT_EQ(touched(upright(), Capsule{{0, 0, 0}, {0, 0, 0}, 5}).size(), 1u);
    EXPECT_TRUE(
        touched(upright(), Capsule{{0, 0, 0}, {0, 0, 0}, std::nextafter(5.0, 0.0)}).empty());
}

// By hand: ends on the face, before it, through it; along an edge; in the plane.
TEST(TouchingCapsule, WithoutRadiusItIsASegment) {
    const TestMesh face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{{0, 1, 2}}}};
    const auto hits = [&](const Double3& from, const Double3& to) {
        return !touched(face, Capsule{from, to, 0}).empty();
    };
    EXPECT_TRUE(hits({1, 1, 5}, {1, 1, 0}));
    EXPECT_FALSE(hits({1, 1, 5}, {1, 1, 0x1p-1074}));
    EXPECT_TRUE(hits({1, 1, 5}, {1, 1, -5}));
    EXPECT_TRUE(hits({-1, 0, 0}, {9, 0, 0}));
    EXPECT_TRUE(hits({3, 3, 0}, {1, 1, 0}));
    EXPECT_TRUE(hits({2, 2, 0}, {3, 3, 0}));
    EXPECT_FALSE(hits({std::nextafter(2.0, 3.0), 2, 0}, {3, 3, 0}));
    EXPECT_FALSE(hits({5, 5, 0}, {9, 0, 0}));
}

TEST(TouchingCapsule, OddRadiiAndEmptyModels) {
    EXPECT_TRUE(touched(upright(), Capsule{{0, 0, 0}, {3, 4, 0}, -1}).empty());
    EXPECT_TRUE(touched(upright(), Capsule{{0, 0, 0}, {3, 4, 0}, std::nan("")}).empty());
    EXPECT_EQ(touched(upright(), Capsule{{0, 0, 0}, {0, 0, 1}, kInfinity}).size(), 1u);
    EXPECT_TRUE(touched({}, Capsule{{0, 0, 0}, {3, 4, 0}, 1}).empty());
    Workspace workspace;
    const OpenModel empty = open_tiny(TestMesh{});
    EXPECT_FALSE(shape_distance(empty.model, Capsule{{0, 0, 0}, {3, 4, 0}, 1}, workspace));
    const OpenModel model = open_tiny(upright());
    EXPECT_FALSE(shape_distance(model.model, Capsule{{0, 0, 0}, {3, 4, 0}, -1}, workspace));
}

// By hand: five less two, with the limit on either side.
TEST(TouchingCapsule, DistanceIsLessByTheRadius) {
    const OpenModel model = open_tiny(upright());
    Workspace workspace;
    const Capsule capsule = {{0, 0, -1}, {0, 0, 1}, 2};
    const auto found = shape_distance(model.model, capsule, workspace);
    ASSERT_TRUE(found);
    EXPECT_LE(found->lower, 3);
    EXPECT_GE(found->upper, 3);
    EXPECT_NEAR(found->upper - found->lower, 0, 1e-13);
    EXPECT_EQ(found->on_model.x, 3);
    EXPECT_EQ(found->on_shape.x, 0);
    EXPECT_TRUE(shape_distance(model.model, capsule, workspace, {.max_distance = 3}));
    EXPECT_FALSE(shape_distance(model.model, capsule, workspace, {.max_distance = 2.999}));
    const auto touching = shape_distance(model.model, Capsule{{0, 0, -1}, {0, 0, 1}, 5}, workspace);
    ASSERT_TRUE(touching);
    EXPECT_EQ(touching->upper, 0);
}

// By hand: the capsules contain the face. The squares of their coordinates are beyond the largest
// double.
TEST(TouchingCapsule, SquaresBeyondDoubleHideNothing) {
    const TestMesh face{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}}};
    for (const double far : {0x1p490, 0x1p505, 0x1p512, 0x1p520, 0x1p900}) {
        const Double3 beside = {far, 0, 0};
        EXPECT_EQ(touched(face, Capsule{beside, beside, 2 * far}).size(), 1u) << far;
        EXPECT_EQ(touched(face, Capsule{beside, beside, far}).size(), 1u) << far;
        EXPECT_TRUE(touched(face, Capsule{beside, beside, far / 2}).empty()) << far;
        EXPECT_EQ(touched(face, Capsule{{-far, 0, 0}, beside, 1}).size(), 1u) << far;
        EXPECT_EQ(touched(face, Capsule{{-far / 2, far, 0}, {far, -far / 2, 0}, far}).size(), 1u)
            << far;
        EXPECT_TRUE(touched(face, Capsule{{-far, 0, 2}, {far, 0, 2}, 1}).empty()) << far;
    }
}

// By hand: the segment runs through the origin, in the model's plane. Its length in frame units is
// beyond the largest double, its ends are not.
TEST(TouchingCapsule, ALengthBeyondDoubleHidesNothing) {
    const double s = 0x1p-25;
    const TestMesh small{{{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {-s, -s, 0}},
                         {{{0, 1, 2}}, {{0, 2, 3}}}};
    for (const double far : {0x1p990, 0x1p998, 0x1p999, 0x1p1000, 0x1p1010}) {
        EXPECT_EQ(touched(small, Capsule{{-far, 0, 0}, {far, 0, 0}, 1}).size(), 2u) << far;
        EXPECT_EQ(touched(small, Capsule{{0, far, 0}, {0, -far, 0}, 0}).size(), 2u) << far;
    }
}

}  // namespace
}  // namespace cdprep::test
