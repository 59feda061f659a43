// SPDX-License-Identifier: MIT
#include "support/exact_rational.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace cdprep::test {
namespace {

// 64-bit integers are the truth for products of three 20-bit numbers.
TEST(ExactNumber, AgreesWithIntegersOnSumsAndProducts) {
    constexpr std::uint32_t kSeed = 1;
    std::mt19937_64 random(kSeed);
    int negative = 0;
    for (int round = 0; round < 20'000; ++round) {
        const auto draw = [&] { return static_cast<std::int64_t>(random() >> 44) - (1LL << 19); };
        const std::int64_t a = draw(), b = draw(), c = draw(), d = draw();
        const std::int64_t truth = a * b * c - d * d;
        const ExactNumber x = static_cast<double>(a), y = static_cast<double>(b),
                          z = static_cast<double>(c), w = static_cast<double>(d);
        const ExactNumber found = x * y * z - w * w;
        const int sign = (truth > 0) - (truth < 0);
        ASSERT_EQ(found.sign(), sign) << "seed " << kSeed << ", round " << round;
        ASSERT_NEAR(static_cast<double>(found.approximation() / static_cast<long double>(truth)), 1,
                    1e-15);
        negative += sign < 0 ? 1 : 0;
    }
    EXPECT_GT(negative, 6'000);
    EXPECT_LT(negative, 14'000);
}

TEST(ExactNumber, HoldsEveryDoubleAndLosesNothing) {
    const double least = 0x1p-1074;
    const double most = 0x1.fffffffffffffp1023;
    const ExactNumber sum = ExactNumber(most) + ExactNumber(least);
    EXPECT_EQ(sum - ExactNumber(most), ExactNumber(least));
    EXPECT_EQ((ExactNumber(least) * ExactNumber(least)).sign(), 1);
    EXPECT_EQ((ExactNumber(0.1) - ExactNumber(0.1)).sign(), 0);
    EXPECT_LT(ExactNumber(-most), ExactNumber(-least));
    EXPECT_EQ(ExactNumber(-0.1).approximation(), static_cast<long double>(-0.1));
}

// (a + b)^2 = a^2 + 2ab + b^2, over exponents from one end of double to the other.
TEST(ExactNumber, ObeysTheBinomialLaw) {
    constexpr std::uint32_t kSeed = 2;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> mantissa(-1, 1);
    std::uniform_int_distribution<int> exponent(-1000, 1000);
    for (int round = 0; round < 2'000; ++round) {
        const ExactNumber a = std::ldexp(mantissa(random), exponent(random));
        const ExactNumber b = std::ldexp(mantissa(random), exponent(random));
        ASSERT_EQ((a + b) * (a + b), a * a + ExactNumber(2) * a * b + b * b) << round;
        ASSERT_NE((a + b) * (a + b), a * a + ExactNumber(3) * a * b + b * b) << round;
    }
}

TEST(ExactRational, DividesWithoutRounding) {
    const ExactRational third = ExactRational(1) / ExactRational(3);
    EXPECT_EQ(third + third + third, ExactRational(1));
    EXPECT_NE(third, ExactRational(1.0 / 3));
    EXPECT_LT(ExactRational(-1) / ExactRational(-3), ExactRational(0.5));
    EXPECT_EQ((ExactRational(1) / ExactRational(-3)).sign(), -1);
    EXPECT_NEAR(static_cast<double>(third.approximation()), 1.0 / 3, 1e-17);
}

}  // namespace
}  // namespace cdprep::test
