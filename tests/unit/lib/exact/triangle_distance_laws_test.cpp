// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "exact/triangle_distance.h"
#include "exact/vectors.h"
#include "support/exact_distance.h"

namespace cdprep::test {
namespace {

/// Where corners come from.
struct Family {
    std::string name;
    double size;    ///< of the triangles
    double gap;     ///< between them, about
    double offset;  ///< of both from the origin
    bool coarse;    ///< corners on a small grid
    double flat;    ///< factor on z: slivers and nearly parallel planes

    friend std::ostream& operator<<(std::ostream& stream, const Family& family) {
        return stream << family.name;
    }
};

Corners random_corners(std::mt19937& random, const Family& family, double lift) {
    std::uniform_real_distribution<double> fine(-1, 1);
    Corners corners{};
    for (Double3& p : corners) {
        const auto next = [&] {
            return family.coarse ? std::round(2 * fine(random)) / 2 : fine(random);
        };
        p = {family.offset + family.size * next(), family.offset + family.size * next(),
             family.offset + family.size * family.flat * next() + lift};
    }
    return corners;
}

class TriangleDistanceLaws : public ::testing::TestWithParam<Family> {};

// The oracle: rational arithmetic. Squares are compared, so no root is taken.
TEST_P(TriangleDistanceLaws, TheIntervalHoldsTheTruth) {
    const Family& family = GetParam();
    std::mt19937 random(20261121);
    int apart = 0, narrow = 0;
    for (int round = 0; round < 3000; ++round) {
        const Corners a = random_corners(random, family, 0);
        const Corners b = random_corners(random, family, family.gap);
        const ExactRational truth = exact_squared_distance(a, b);
        if (truth.sign() == 0) continue;
        ++apart;
        for (const bool tight : {false, true}) {
            const TriangleDistance d = triangle_distance(a, b, tight);
            const ExactRational lower = square(d.lower);
            const ExactRational upper = square(d.upper);
            ASSERT_TRUE(lower <= truth) << "round " << round << ": " << d.lower;
            ASSERT_TRUE(truth <= upper) << "round " << round << ": " << d.upper;
            const double dx = d.on_b.x - d.on_a.x, dy = d.on_b.y - d.on_a.y,
                         dz = d.on_b.z - d.on_a.z;
            const double slack = 3e-15 * (std::fabs(family.offset) + family.size + family.gap);
            ASSERT_NEAR(std::hypot(dx, dy, dz), d.upper, 1e-12 * d.upper + 4 * slack);
            if (tight) {
                const double largest = std::fabs(family.offset) + family.size + family.gap;
                narrow += d.upper - d.lower <= 1e-12 * d.lower + 1e-15 * largest ? 1 : 0;
            }
        }
    }
    EXPECT_GT(apart, 300);
    EXPECT_EQ(narrow, apart);
}

INSTANTIATE_TEST_SUITE_P(Situations, TriangleDistanceLaws,
                         ::testing::Values(Family{"plain", 1, 1, 0, false, 1},
                                           Family{"near", 1, 0.1, 0, false, 0.01},
                                           Family{"coarse", 1, 1, 0, true, 1},
                                           Family{"far", 1, 1000, 0, false, 1},
                                           Family{"parallel_planes", 1, 1e-3, 0, false, 0},
                                           Family{"nearly_parallel", 1, 1e-6, 0, false, 1e-9},
                                           Family{"touching_nearly", 1, 1e-12, 0, true, 0},
                                           Family{"far_from_the_origin", 1, 1, 1e6, false, 1},
                                           Family{"tiny", 1e-200, 1e-200, 0, false, 1},
                                           Family{"huge", 1e200, 1e200, 0, false, 1}),
                         [](const auto& family) { return family.param.name; });

TEST(TriangleDistance, ATriangleWithEqualCornersIsItsSegment) {  // X03
    const Corners point = {{{1.1, -7.9, 16.588}, {1.1, -7.9, 16.588}, {1.1, -7.9, 16.588}}};
    const Corners segment = {{{2.277, -7.9, 16.318}, {-0.57, -8.1, 16.607}, {-0.57, -8.1, 16.607}}};
    const TriangleDistance d = triangle_distance(point, segment, true);
    EXPECT_NEAR(d.upper, 0.17147936968945224, 1e-14);
    const ExactRational truth = exact_squared_distance(point, segment);
    EXPECT_TRUE(square(d.lower) <= truth && truth <= square(d.upper));
    EXPECT_LE(d.upper - d.lower, 1e-12 * d.lower + 1e-15 * 16.607);
}

TEST(TriangleDistance, NearlyParallelEdges) {  // X02
    const double angle = 0x1p-30;
    const Corners a = {{{-1, 0, 0}, {1, 0, 0}, {0, -1, -1}}};
    const Corners b = {{{-1, -angle, 1}, {1, angle, 1}, {0, 1, 2}}};
    const TriangleDistance d = triangle_distance(a, b, true);
    // By hand: the edges cross over the origin.
    EXPECT_TRUE(exact_squared_distance(a, b) == square(1));
    EXPECT_LE(d.lower, 1);
    EXPECT_GE(d.upper, 1);
    EXPECT_LE(d.upper - d.lower, 1e-12);
}

// By hand: the segment runs above the origin. Its length is beyond the largest double.
TEST(TriangleDistance, OfASegmentOfAnyLengthHoldsTheTruth) {
    const Corners t = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const Corners segment = {{{-1e308, 0, 5}, {1e308, 0, 5}, {1e308, 0, 5}}};
    for (const bool tight : {false, true}) {
        for (const TriangleDistance& d :
             {triangle_distance(t, segment, tight), triangle_distance(segment, t, tight)}) {
            EXPECT_LE(d.lower, 5);
            EXPECT_GE(d.upper, 5);
            EXPECT_LE(d.upper, 0x1p-46 * 1e308);
            EXPECT_TRUE(is_finite(d.on_a) && is_finite(d.on_b));
        }
    }
}

}  // namespace
}  // namespace cdprep::test
