// SPDX-License-Identifier: MIT
#include "accuracy/pair_errors.h"

#include <gtest/gtest.h>

#include <vector>

namespace cdprep::study {
namespace {

// By hand: 12 of 15 wanted are among 14 found, so 17 are in either set.
TEST(PairErrors, AreThoseOfTheSums) {
    const PairErrors errors = pair_errors(std::vector<PairCounts>{{10, 8, 8}, {5, 6, 4}});
    EXPECT_EQ(errors.all, (PairCounts{15, 14, 12}));
    EXPECT_DOUBLE_EQ(errors.recall.share, 12.0 / 15);
    EXPECT_DOUBLE_EQ(errors.precision.share, 12.0 / 14);
    EXPECT_DOUBLE_EQ(errors.wrong.share, 5.0 / 17);
}

// By hand: of two poses, one all right and one all missing, a quarter of the draws has the
// first twice and a quarter the second twice: both ends are beyond 2.5 %.
TEST(PairErrors, BandsComeFromPosesThatAreDrawnAgain) {
    const PairErrors errors = pair_errors(std::vector<PairCounts>{{10, 10, 10}, {10, 0, 0}});
    EXPECT_EQ(errors.recall.low, 0);
    EXPECT_EQ(errors.recall.share, 0.5);
    EXPECT_EQ(errors.recall.high, 1);
    EXPECT_EQ(errors.precision.low, 1);  // of none that was found none is too many
    EXPECT_EQ(errors.wrong.low, 0);
    EXPECT_EQ(errors.wrong.high, 1);
}

// By hand: the share of n poses that are all wrong has the standard deviation
// sqrt(p (1 - p) / n) = 0.05, and 95 % lie within 1.96 of these.
TEST(PairErrors, BandsOfManyPosesAreThoseOfTheNormalDistribution) {
    std::vector<PairCounts> poses(100, PairCounts{7, 7, 7});
    for (std::size_t i = 0; i < 50; ++i) poses[i].both = 0;
    const PairErrors errors = pair_errors(poses);
    EXPECT_NEAR(errors.recall.low, 0.5 - 0.098, 0.025);
    EXPECT_NEAR(errors.recall.high, 0.5 + 0.098, 0.025);
}

// By definition, where nothing is wanted and nothing found.
TEST(PairErrors, OfNothingAreNone) {
    for (const std::vector<PairCounts>& poses :
         {std::vector<PairCounts>{}, std::vector<PairCounts>(3)}) {
        const PairErrors errors = pair_errors(poses);
        EXPECT_EQ(errors.recall.share, 1);
        EXPECT_EQ(errors.precision.low, 1);
        EXPECT_EQ(errors.wrong.high, 0);
    }
}

}  // namespace
}  // namespace cdprep::study
