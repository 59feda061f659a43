// SPDX-License-Identifier: MIT
#include "text/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace cdprep::report {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double read(const std::string& text) {
    return std::strtod(text.data(), nullptr);
}

// By hand: the next number of six digits, where the nearest one is on the wrong side.
TEST(BoundsInSixDigits, AreRoundedAwayFromTheValue) {
    EXPECT_EQ(at_most_in_six_digits(1.2345611), "1.23457");
    EXPECT_EQ(at_least_in_six_digits(1.2345611), "1.23456");
    EXPECT_EQ(at_most_in_six_digits(1.2345679), "1.23457");
    EXPECT_EQ(at_least_in_six_digits(1.2345679), "1.23456");
    EXPECT_EQ(at_most_in_six_digits(999999.25), "1e+06");
    EXPECT_EQ(at_least_in_six_digits(999999.75), "999999");
    EXPECT_EQ(at_most_in_six_digits(1.00000004e-300), "1.00001e-300");
    EXPECT_EQ(at_most_in_six_digits(-1.2345679), "-1.23456");
    EXPECT_EQ(at_least_in_six_digits(-1.2345611), "-1.23457");
    EXPECT_EQ(at_most_in_six_digits(std::numeric_limits<double>::max()), "inf");
}

TEST(BoundsInSixDigits, PrintWhatSixDigitsHoldAsItIs) {
    for (const double value : {0.0, 1.0, 0.1, 0.707107, 2.5, 123456.0, 1e300, 5e-324, kInfinity}) {
        EXPECT_EQ(at_most_in_six_digits(value), in_six_digits(value));
        EXPECT_EQ(at_least_in_six_digits(value), in_six_digits(value));
        EXPECT_EQ(at_most_in_six_digits(-value), in_six_digits(-value));
        EXPECT_EQ(at_least_in_six_digits(-value), in_six_digits(-value));
    }
}

// By the law that defines them, for doubles of every size.
TEST(BoundsInSixDigits, ReadBackAsBounds) {
    constexpr unsigned kSeed = 77;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    int rounded_up = 0;
    int tried = 0;
    for (int round = 0; round < 100'000 && !HasFailure(); ++round) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        ++tried;
        const double most = read(at_most_in_six_digits(value));
        const double least = read(at_least_in_six_digits(value));
        EXPECT_GE(most, value) << number_text(value);
        EXPECT_LE(least, value) << number_text(value);
        const double nearest = read(in_six_digits(value));
        EXPECT_TRUE(nearest == most || nearest == least) << number_text(value);
        rounded_up += nearest < value;
    }
    EXPECT_GT(rounded_up, 3 * tried / 10);
    EXPECT_LT(rounded_up, 7 * tried / 10);
}

}  // namespace
}  // namespace cdprep::report
