// SPDX-License-Identifier: MIT
#include "mesh/exact_volume.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "support/exact_rational.h"

namespace cdprep::mesh {
namespace {

using test::ExactNumber;
using Point = std::array<double, 3>;
using Corner3 = std::array<Point, 3>;

ExactNumber determinant(const Point& a, const Point& b, const Point& c) {
    return ExactNumber(a[0]) * (ExactNumber(b[1]) * c[2] - ExactNumber(b[2]) * c[1]) +
           ExactNumber(a[1]) * (ExactNumber(b[2]) * c[0] - ExactNumber(b[0]) * c[2]) +
           ExactNumber(a[2]) * (ExactNumber(b[0]) * c[1] - ExactNumber(b[1]) * c[0]);
}

// Exact numbers are the oracle; coordinates of every size, and sums that nearly cancel.
TEST(ExactVolume, HasTheSignAndSizeOfTheExactSum) {
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> mantissa(-1, 1);
    std::array<int, 3> signs{};
    for (int round = 0; round < 300; ++round) {
        std::uniform_int_distribution<int> exponent(round % 3 == 0 ? -1074 : -40,
                                                    round % 3 == 0 ? 300 : 40);
        ExactVolume volume;
        ExactNumber sum;
        for (int i = 0; i < 4; ++i) {
            Corner3 t;
            for (Point& p : t) {
                for (double& x : p) x = std::ldexp(mantissa(random), exponent(random));
            }
            // And turned round, but for one bit of one corner, or none.
            Corner3 back = {t[0], t[2], t[1]};
            if (i == 0 && round % 4 != 0) back[1][0] = std::nextafter(back[1][0], 1e300);
            for (const Corner3& c : {t, back}) {
                volume.add({c[0][0], c[0][1], c[0][2]}, {c[1][0], c[1][1], c[1][2]},
                           {c[2][0], c[2][1], c[2][2]});
                sum = sum + determinant(c[0], c[1], c[2]);
            }
        }
        EXPECT_EQ(volume.sign(), sum.sign()) << "round " << round;
        const auto expected = static_cast<double>(sum.approximation() / 6);
        EXPECT_DOUBLE_EQ(volume.volume(), expected) << "round " << round;
        ++signs[static_cast<std::size_t>(sum.sign() + 1)];
    }
    for (const int count : signs) EXPECT_GT(count, 50);
}

// The tetrahedron under one triangle whose corners lie on the axes: x y z / 6.
TEST(ExactVolume, ReachesFromTheLeastDoublesToTheLargest) {
    ExactVolume none;
    EXPECT_EQ(none.sign(), 0);
    EXPECT_EQ(none.volume(), 0);
    const double least = std::numeric_limits<double>::denorm_min();
    ExactVolume tiny;
    tiny.add({least, 0, 0}, {0, least, 0}, {0, 0, least});
    EXPECT_EQ(tiny.sign(), 1);
    EXPECT_EQ(tiny.volume(), 0);  // 2^-3222 / 6 is no double
    const double largest = std::numeric_limits<double>::max();
    ExactVolume huge;
    huge.add({-largest, 0, 0}, {0, largest, 0}, {0, 0, largest});
    EXPECT_EQ(huge.sign(), -1);
    EXPECT_EQ(huge.volume(), -largest);
    // And a least one on top is not lost.
    huge.add({largest, 0, 0}, {0, largest, 0}, {0, 0, largest});
    EXPECT_EQ(huge.sign(), 0);
    huge.add({least, 0, 0}, {0, least, 0}, {0, 0, least});
    EXPECT_EQ(huge.sign(), 1);
}

}  // namespace
}  // namespace cdprep::mesh
