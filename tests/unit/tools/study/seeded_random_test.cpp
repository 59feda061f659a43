// SPDX-License-Identifier: MIT
#include "study/seeded_random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cdprep::study {
namespace {

// From the reference implementation (Vigna, splitmix64.c).
TEST(SeededRandom, BitsAreThoseOfSplitMix64) {
    SeededRandom random(0);
    EXPECT_EQ(random.bits(), 0xe220a8397b1dcdafU);
    EXPECT_EQ(random.bits(), 0x6e789e6aa1b965f4U);
    EXPECT_EQ(random.bits(), 0x06c45d188009454fU);
}

TEST(SeededRandom, NumbersStayWithinTheirRange) {
    SeededRandom random(7);
    double least = 1;
    double most = 0;
    for (int i = 0; i < 10'000; ++i) {
        const double share = random.share();
        least = std::min(least, share);
        most = std::max(most, share);
        ASSERT_GE(share, 0);
        ASSERT_LT(share, 1);
        ASSERT_LT(random.below(3), 3U);
        const double factor = random.between_by_factors(1e-6, 1e-2);
        ASSERT_GE(factor, 1e-6 * (1 - 1e-12));
        ASSERT_LE(factor, 1e-2 * (1 + 1e-12));
    }
    EXPECT_LT(least, 0.001);
    EXPECT_GT(most, 0.999);
}

// By symmetry as many point each way; 4000 draws vary by 32 (one standard deviation).
TEST(SeededRandom, DirectionsHaveLengthOneAndPointEverywhere) {
    SeededRandom random(11);
    int up = 0;
    for (int i = 0; i < 4000; ++i) {
        const format::Double3 d = random.direction();
        ASSERT_NEAR(std::hypot(d.x, d.y, d.z), 1, 1e-14);
        if (d.z > 0) ++up;
    }
    EXPECT_GT(up, 1840);
    EXPECT_LT(up, 2160);
}

}  // namespace
}  // namespace cdprep::study
