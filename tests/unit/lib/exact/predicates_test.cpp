// SPDX-License-Identifier: MIT
#include "exact/predicates.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <random>

#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

int exact_orient2d(const Double2& a, const Double2& b, const Double2& c) {
    const auto minus = [](double x, double y) { return ExactNumber(x) - ExactNumber(y); };
    return (minus(a.x, c.x) * minus(b.y, c.y) - minus(a.y, c.y) * minus(b.x, c.x)).sign();
}

int exact_orient3d(const Double3& a, const Double3& b, const Double3& c, const Double3& d) {
    const auto minus = [](double x, double y) { return ExactNumber(x) - ExactNumber(y); };
    const ExactNumber ax = minus(a.x, d.x), ay = minus(a.y, d.y), az = minus(a.z, d.z);
    const ExactNumber bx = minus(b.x, d.x), by = minus(b.y, d.y), bz = minus(b.z, d.z);
    const ExactNumber cx = minus(c.x, d.x), cy = minus(c.y, d.y), cz = minus(c.z, d.z);
    return (ax * (by * cz - bz * cy) + bx * (cy * az - cz * ay) + cx * (ay * bz - az * by)).sign();
}

TEST(Orient2d, IsPositiveForCounterClockwiseTurns) {
    EXPECT_EQ(orient2d(Double2{0, 0}, {1, 0}, {0, 1}), 1);
    EXPECT_EQ(orient2d(Double2{0, 0}, {0, 1}, {1, 0}), -1);
    EXPECT_EQ(orient2d(Double2{0, 0}, {1, 1}, {2, 2}), 0);
}

TEST(Orient3d, IsPositiveForPointsBehindACounterClockwiseTriangle) {
    const Double3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    EXPECT_EQ(orient3d(a, b, c, {0, 0, -1}), 1);
    EXPECT_EQ(orient3d(a, b, c, {0, 0, 1}), -1);
    EXPECT_EQ(orient3d(a, b, c, {7, -5, 0}), 0);
}

// 0.1, 0.2 and 0.3 are no tenths: 0.3 - 0.2 is not 0.2 - 0.1, and the sign of the
// determinant is that of the last bit. In exact arithmetic by hand:
// 0.1 = 3602879701896397 2^-55, 0.2 twice that, 0.3 = 10808639105689190 2^-55,
// one less than three times the first.
TEST(Orient2d, SeesTheLastBit) {
    EXPECT_EQ(orient2d(Double2{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}), 0);
    EXPECT_EQ(orient2d(Double2{0.1, 1}, {0.2, 2}, {0.3, 3}), 1);
    EXPECT_EQ(orient3d(Double3{0.1, 1, 0}, {0.2, 2, 0}, {0.1, 1, 1}, {0.3, 3, 0}), 1);
}

// A point one ulp off a plane: the filter must pass it on, and the rest decide it.
TEST(Orient3d, SeesOneUlpOffAPlane) {
    const Double3 a{12, 12, 12}, b{24, 24, 25}, c{11, 13, 12};
    const Double3 on{18, 18, 18.5};
    EXPECT_EQ(orient3d(a, b, c, on), 0);
    const int above = orient3d(a, b, c, {18, 18, std::nextafter(18.5, 20)});
    const int below = orient3d(a, b, c, {18, 18, std::nextafter(18.5, 10)});
    EXPECT_NE(above, 0);
    EXPECT_EQ(above, -below);
}

TEST(Orient3d, IsZeroWhenTwoPointsAreEqual) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int round = 0; round < 1'000; ++round) {
        std::array<Double3, 4> p;
        for (Double3& q : p) q = {uniform(random), uniform(random), uniform(random)};
        p[static_cast<std::size_t>(round % 4)] = p[static_cast<std::size_t>((round + 1) % 4)];
        ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), 0) << "seed 5, round " << round;
    }
}

/// Where coordinates come from: every source makes another stage decide.
struct Source {
    const char* name;
    double (*draw)(std::mt19937&);

    friend std::ostream& operator<<(std::ostream& stream, const Source& source) {
        return stream << source.name;
    }
};

double unit(std::mt19937& random) {
    return std::uniform_real_distribution<double>(-1, 1)(random);
}
double coarse(std::mt19937& random) {
    return std::uniform_int_distribution<int>(-2, 2)(random);
}
double coarse_tenths(std::mt19937& random) {
    return 0.1 * coarse(random);
}
double coarse_floats(std::mt19937& random) {
    return 0.1F * static_cast<float>(coarse(random));
}
double subnormal(std::mt19937& random) {
    return 0x1p-1074 * coarse(random);
}
double small(std::mt19937& random) {
    return 0x1p-600 * coarse_tenths(random);
}
double huge(std::mt19937& random) {
    return 0x1p1000 * 0.25 * coarse(random);
}
double huge_tenths(std::mt19937& random) {
    return 0x1p998 * coarse_tenths(random);
}
double largest(std::mt19937& random) {
    return 0x1.fffffffffffffp1023 * 0.25 * coarse(random);
}
double all_exponents(std::mt19937& random) {
    return std::ldexp(unit(random), std::uniform_int_distribution<int>(-1074, 1000)(random));
}
double few_exponents(std::mt19937& random) {
    return std::ldexp(coarse(random), 500 * std::uniform_int_distribution<int>(-2, 1)(random));
}
double two_exponents(std::mt19937& random) {
    return coarse(random) + 0x1p-90 * coarse(random);
}

constexpr std::array<Source, 12> kSources = {{{"unit", unit},
                                              {"coarse", coarse},
                                              {"coarse_tenths", coarse_tenths},
                                              {"coarse_floats", coarse_floats},
                                              {"subnormal", subnormal},
                                              {"small", small},
                                              {"huge", huge},
                                              {"huge_tenths", huge_tenths},
                                              {"largest", largest},
                                              {"all_exponents", all_exponents},
                                              {"few_exponents", few_exponents},
                                              {"two_exponents", two_exponents}}};

class Predicates : public testing::TestWithParam<Source> {};

TEST_P(Predicates, AgreeWithExactNumbers) {
    constexpr std::uint32_t kSeed = 20261121;
    std::mt19937 random(kSeed);
    const auto draw = [&] { return GetParam().draw(random); };
    std::array<int, 3> seen{};
    for (int round = 0; round < 4'000; ++round) {
        const Double3 a{draw(), draw(), draw()}, b{draw(), draw(), draw()};
        const Double3 c{draw(), draw(), draw()}, d{draw(), draw(), draw()};
        const int truth = exact_orient3d(a, b, c, d);
        ASSERT_EQ(orient3d(a, b, c, d), truth) << "seed " << kSeed << ", round " << round;
        ASSERT_EQ(plane_signs({a, b, c}, {d, c, d})[2], truth) << round;
        ASSERT_EQ(orient2d(Double2{a.x, a.y}, {b.x, b.y}, {c.x, c.y}),
                  exact_orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}))
            << "seed " << kSeed << ", round " << round;
        ++seen[static_cast<std::size_t>(truth + 1)];
    }
    EXPECT_GT(seen[0], 800);
    EXPECT_GT(seen[2], 800);
}

// Exchanging two points changes the sign, whatever stage decides.
TEST_P(Predicates, ChangeSignWithEveryExchange) {
    constexpr std::uint32_t kSeed = 3;
    std::mt19937 random(kSeed);
    const auto draw = [&] { return GetParam().draw(random); };
    for (int round = 0; round < 4'000; ++round) {
        std::array<Double3, 4> p;
        for (Double3& q : p) q = {draw(), draw(), draw()};
        const int sign = orient3d(p[0], p[1], p[2], p[3]);
        ASSERT_EQ(orient3d(p[1], p[0], p[2], p[3]), -sign) << kSeed << ' ' << round;
        ASSERT_EQ(orient3d(p[0], p[2], p[1], p[3]), -sign) << kSeed << ' ' << round;
        ASSERT_EQ(orient3d(p[0], p[1], p[3], p[2]), -sign) << kSeed << ' ' << round;
        ASSERT_EQ(orient3d(p[3], p[0], p[1], p[2]), -sign) << kSeed << ' ' << round;
    }
}

// Nearly flat on purpose: d = a + s (b - a) + t (c - a), rounded, and a step off.
TEST_P(Predicates, AgreeWithExactNumbersNearThePlane) {
    constexpr std::uint32_t kSeed = 4;
    std::mt19937 random(kSeed);
    const auto draw = [&] { return GetParam().draw(random); };
    std::array<int, 3> seen{};
    for (int round = 0; round < 3'000; ++round) {
        const Double3 a{draw(), draw(), draw()}, b{draw(), draw(), draw()};
        const Double3 c{draw(), draw(), draw()};
        const double s = 0.25 + 0.125 * unit(random), t = 0.25 + 0.125 * unit(random);
        const double r = 1 - s - t;
        Double3 d{r * a.x + s * b.x + t * c.x, r * a.y + s * b.y + t * c.y,
                  r * a.z + s * b.z + t * c.z};
        if (round % 3 == 1) d.z = std::nextafter(d.z, 0x1p1023);
        const int truth = exact_orient3d(a, b, c, d);
        ASSERT_EQ(orient3d(a, b, c, d), truth) << "seed " << kSeed << ", round " << round;
        ++seen[static_cast<std::size_t>(truth + 1)];
    }
    EXPECT_GT(seen[0], 150);
    EXPECT_GT(seen[2], 150);
}

INSTANTIATE_TEST_SUITE_P(Coordinates, Predicates, testing::ValuesIn(kSources),
                         [](const auto& source) { return source.param.name; });

}  // namespace
}  // namespace cdprep::test
