// SPDX-License-Identifier: MIT
#include "study/share_interval.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cdprep::study {
namespace {

// In closed form: no hit in n with probability (1 - p)^n, so p = 1 - 0.025^(1/n).
TEST(ClopperPearson, NoneAndAllHaveClosedForms) {
    for (const std::size_t n : {1U, 10U, 250U, 10'000U}) {
        const double end = 1 - std::pow(0.025, 1.0 / static_cast<double>(n));
        const ShareInterval none = clopper_pearson(0, n);
        EXPECT_EQ(none.low, 0);
        EXPECT_NEAR(none.high, end, 1e-9);
        const ShareInterval all = clopper_pearson(n, n);
        EXPECT_NEAR(all.low, 1 - end, 1e-9);
        EXPECT_EQ(all.high, 1);
    }
}

// Published tables (Zar, Biostatistical Analysis; binom.test of R).
TEST(ClopperPearson, AgreesWithTables) {
    const ShareInterval half = clopper_pearson(5, 10);
    EXPECT_NEAR(half.low, 0.18708603, 1e-8);
    EXPECT_NEAR(half.high, 0.81291397, 1e-8);
    const ShareInterval seven = clopper_pearson(7, 21);
    EXPECT_NEAR(seven.low, 0.1458769, 1e-6);
    EXPECT_NEAR(seven.high, 0.5696755, 1e-6);
    EXPECT_EQ(half.share(), 0.5);
}

// By symmetry hits and misses swap.
TEST(ClopperPearson, HitsAndMissesSwap) {
    for (std::size_t count = 0; count <= 40; ++count) {
        const ShareInterval hits = clopper_pearson(count, 40);
        const ShareInterval misses = clopper_pearson(40 - count, 40);
        EXPECT_NEAR(hits.low, 1 - misses.high, 1e-9);
        EXPECT_LE(hits.low, hits.share());
        EXPECT_GE(hits.high, hits.share());
    }
}

TEST(ClopperPearson, NothingIsKnownFromNoCases) {
    const ShareInterval none = clopper_pearson(0, 0);
    EXPECT_EQ(none.low, 0);
    EXPECT_EQ(none.high, 1);
    EXPECT_EQ(none.share(), 0);
}

}  // namespace
}  // namespace cdprep::study
