// SPDX-License-Identifier: MIT
#include "hull/difference_side.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

Difference difference(const Double3& a, const Double3& b) {
    return {0, 0, a, b, {a.x - b.x, a.y - b.y, a.z - b.z}};
}

using ExactPoint = std::array<ExactNumber, 3>;

ExactPoint exact(const Difference& p) {
    return {ExactNumber(p.at_a.x) - ExactNumber(p.at_b.x),
            ExactNumber(p.at_a.y) - ExactNumber(p.at_b.y),
            ExactNumber(p.at_a.z) - ExactNumber(p.at_b.z)};
}

/// By the definition, in exact numbers.
int side(const Difference& p, const Difference& q, const Difference& r, const Difference& d) {
    const ExactPoint from = exact(d);
    std::array<ExactPoint, 3> row = {exact(p), exact(q), exact(r)};
    for (ExactPoint& point : row) {
        for (std::size_t k = 0; k < 3; ++k) point[k] = point[k] - from[k];
    }
    const auto minor = [&](std::size_t i, std::size_t j) {
        return row[0][i] * row[1][j] - row[0][j] * row[1][i];
    };
    return (minor(1, 2) * row[2][0] + minor(2, 0) * row[2][1] + minor(0, 1) * row[2][2]).sign();
}

// Four corners nearly in one plane, which is flat along a different axis each round: a filter
// that takes the least size for the largest calls rounding a side.
TEST(DifferenceSide, AgreesWithExactNumbersWhereSizesDiffer) {
    constexpr std::uint32_t kSeed = 41;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::array<int, 3> seen{};
    for (int round = 0; round < 20000; ++round) {
        const std::size_t thin = static_cast<std::size_t>(round % 3);
        const auto at = [&](double size) {
            std::array<double, 3> x = {unit(random), unit(random), unit(random)};
            x[thin] *= size;
            return Double3{x[0], x[1], x[2]};
        };
        // The last is a sum of multiples of the others, up to rounding, each a difference.
        const Difference p = difference(at(1e-9), at(1e-9)), q = difference(at(1), at(1));
        const Difference d = difference({}, {});
        const double s = unit(random), t = unit(random);
        const auto sum = [&](const Double3& x, const Double3& y) {
            return Double3{s * x.x + t * y.x, s * x.y + t * y.y, s * x.z + t * y.z};
        };
        const Difference r = difference(sum(p.at_a, q.at_a), sum(p.at_b, q.at_b));
        const std::array<const Difference*, 3> order = {&p, &q, &r};
        const std::size_t turn = static_cast<std::size_t>(round / 3 % 3);
        const Difference &x = *order[turn], &y = *order[(turn + 1) % 3],
                         &z = *order[(turn + 2) % 3];
        const int expected = side(x, y, z, d);
        ASSERT_EQ(side_of(x, y, z, d), expected) << "seed " << kSeed << ", round " << round;
        ++seen[static_cast<std::size_t>(expected + 1)];
    }
    EXPECT_GT(seen[0], 5000);
    EXPECT_GT(seen[2], 5000);
}

}  // namespace
}  // namespace cdprep::test
