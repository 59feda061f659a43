// SPDX-License-Identifier: MIT
#include "exact/integer_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

ExactNumber exact_number(std::int64_t i) {
    const double high = static_cast<double>(i / (1 << 20)) * (1 << 20);
    return ExactNumber(high) +
           ExactNumber(static_cast<double>(i - static_cast<std::int64_t>(high)));
}

template <class Row>
int determinant_sign(const Row& r) {
    const auto minor = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
        return exact_number(r[a]) * exact_number(r[d]) - exact_number(r[b]) * exact_number(r[c]);
    };
    return (exact_number(r[0]) * minor(4, 5, 7, 8) - exact_number(r[1]) * minor(3, 5, 6, 8) +
            exact_number(r[2]) * minor(3, 4, 6, 7))
        .sign();
}

// Integers keep every ratio: cross-multiplied in exact arithmetic.
TEST(ScaledAxis, HoldsTheDifferencesTimesOneNumber) {
    constexpr std::uint32_t kSeed = 62;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> unit(-1, 1);
    int fitting = 0;
    constexpr int kRounds = 5000;
    for (int round = 0; round < kRounds; ++round) {
        const double near = std::ldexp(1.0, -(round % 20));
        const double size = std::ldexp(1.0, round % 8 * 280 - 1000);
        const double from = size * (round % 3 == 0 ? 0x1p-30 * unit(random) : unit(random));
        std::array<double, 5> x;
        for (double& value : x) value = from + size * near * unit(random);
        const auto scaled = scaled_axis(x, from, 62);
        if (!scaled.fits) continue;
        ++fitting;
        std::array<ExactNumber, 5> d;
        std::size_t largest = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            d[i] = ExactNumber(x[i]) - ExactNumber(from);
            if (std::abs(scaled.at[i]) > std::abs(scaled.at[largest])) largest = i;
        }
        const std::int64_t most = std::abs(scaled.at[largest]);
        EXPECT_GE(most, (std::int64_t{1} << 61) - (1 << 9)) << "seed " << kSeed;
        EXPECT_LE(most, (std::int64_t{1} << 62) + (1 << 9)) << "seed " << kSeed;
        EXPECT_EQ(exact_number(most).sign(), 1);
        EXPECT_EQ(exact_number(scaled.at[largest]).sign(), d[largest].sign());
        for (std::size_t i = 0; i < x.size(); ++i) {
            ASSERT_EQ(exact_number(scaled.at[i]) * d[largest],
                      exact_number(scaled.at[largest]) * d[i])
                << "seed " << kSeed << ", round " << round;
        }
    }
    EXPECT_GT(fitting, kRounds * 3 / 10);
    EXPECT_LT(fitting, kRounds * 9 / 10);
}

TEST(ScaledAxis, DoesNotFitWhereBitsAreMissing) {
    const auto fits = [](double large, double small) {
        return scaled_axis<2>({large, small}, 0, 62).fits;
    };
    EXPECT_TRUE(fits(1, 0x1p-61));
    EXPECT_FALSE(fits(1, 0x1p-62));
    EXPECT_TRUE(fits(0x1p1000, 0x1p939));
    EXPECT_FALSE(fits(0x1p1000, 0x1p-1074));  // the product would be 0
    EXPECT_TRUE(fits(0x1p-900, 0x1p-961));
    EXPECT_TRUE(fits(0x1p-1013, 0x1p-1074));
    EXPECT_FALSE(fits(0x1p-1012, 0x1p-1074));
    EXPECT_TRUE(fits(0x1p-1074, 0x1p-1074));
    EXPECT_TRUE(fits(0, 0));
    const double largest = std::numeric_limits<double>::max();
    EXPECT_FALSE(scaled_axis<2>({largest, 1}, -largest, 62).fits);
}

// The largest permitted integers, with determinants that are 0, or one off.
TEST(IntegerPoints, SignsAreExactUpToTheLimit) {
    constexpr std::uint32_t kSeed = 61;
    constexpr std::int64_t kMost = (std::int64_t{1} << 61) + (1 << 8);
    std::mt19937_64 random(kSeed);
    std::array<int, 3> seen{};
    for (int round = 0; round < 5000; ++round) {
        const auto coordinate = [&] {
            const auto any = static_cast<std::int64_t>(random()) % kMost;
            return round % 3 == 0 ? any : (random() % 2 == 0 ? kMost : -kMost) + (any & 1);
        };
        const auto point = [&] { return Integer3{coordinate(), coordinate(), coordinate()}; };
        const Integer3 a = point(), b = point(), c = point(), d = point();
        const std::array<std::int64_t, 9> rows = {a.x - d.x, a.y - d.y, a.z - d.z,
                                                  b.x - d.x, b.y - d.y, b.z - d.z,
                                                  c.x - d.x, c.y - d.y, c.z - d.z};
        const int sign = determinant_sign(rows);
        ++seen[static_cast<std::size_t>(sign + 1)];
        ASSERT_EQ(orient3d(a, b, c, d), sign) << "seed " << kSeed << ", round " << round;
        const std::array<int, 3> signs = plane_signs({a, b, c}, {d, a, d});
        ASSERT_EQ(signs[0], sign) << "seed " << kSeed << ", round " << round;
        ASSERT_EQ(signs[1], 0);
        ASSERT_EQ(signs[2], sign);
        const auto exact_2d = exact_number(rows[0]) * exact_number(rows[4]) -
                              exact_number(rows[1]) * exact_number(rows[3]);
        ASSERT_EQ(orient2d(Integer2{a.x, a.y}, {b.x, b.y}, {d.x, d.y}), exact_2d.sign());
    }
    for (const int count : seen) EXPECT_GT(count, 500);
}

}  // namespace
}  // namespace cdprep::test
