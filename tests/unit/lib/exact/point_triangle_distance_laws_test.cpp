// SPDX-License-Identifier: MIT
#include "exact/point_triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <random>

#include "support/exact_distance.h"

namespace cdprep::test {
namespace {

/// A situation: a triangle of edges about `size`, about `away` from the point.
struct Situation {
    const char* name;
    double away;
    double size;
    bool sliver;
    int exponent;  ///< all coordinates times 2^exponent

    friend std::ostream& operator<<(std::ostream& stream, const Situation& situation) {
        return stream << situation.name;
    }
};

constexpr Situation kSituations[] = {
    {"near", 1, 1, false, 0},
    {"on_it", 0, 1, false, 0},
    {"close_to_large", 1e-6, 1, false, 0},
    {"far_from_small", 1, 1e-4, false, 0},
    {"far_from_tiny", 1, 1e-10, false, 0},
    {"far_from_dust", 1, 1e-14, false, 0},
    {"sliver", 1, 1, true, 0},
    {"sliver_on_it", 0, 1, true, 0},
    {"sliver_far_away", 1, 1e-7, true, 0},
    {"subnormal", 1, 1, false, -1060},
    {"small", 1, 1, false, -1000},
    {"large", 1, 1, false, 900},
};

class PointTriangleDistanceLaws : public testing::TestWithParam<Situation> {};

Double3 uniform(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> component(-size, size);
    const double x = component(random), y = component(random), z = component(random);
    return {x, y, z};
}

Double3 sum(const Double3& a, const Double3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

Corners draw_triangle(std::mt19937& random, const Situation& situation) {
    Corners t;
    const Double3 middle = uniform(random, 1);
    for (Double3& p : t) p = sum(middle, uniform(random, situation.size));
    if (situation.sliver) {
        const double s = std::uniform_real_distribution<double>(0, 1)(random);
        const double off =
            std::ldexp(situation.size, -std::uniform_int_distribution<int>(5, 60)(random));
        const Double3 on = {t[0].x + s * (t[1].x - t[0].x), t[0].y + s * (t[1].y - t[0].y),
                            t[0].z + s * (t[1].z - t[0].z)};
        t[2] = sum(on, uniform(random, off));
    }
    return t;
}

/// Above a random point of the plane near the triangle.
Double3 draw_point(std::mt19937& random, const Situation& situation, const Corners& t) {
    std::uniform_real_distribution<double> weight(-0.3, 1);
    const double u = weight(random), v = weight(random), w = 1 - u - v;
    const Double3 on = {u * t[0].x + v * t[1].x + w * t[2].x, u * t[0].y + v * t[1].y + w * t[2].y,
                        u * t[0].z + v * t[1].z + w * t[2].z};
    return sum(on, uniform(random, situation.away));
}

/// A point of the plane z = x / 2 + y / 4 on a grid so coarse that nothing rounds.
Double3 on_tilted_plane(std::mt19937& random, double size) {
    const double step = std::ldexp(1.0, std::ilogb(size) - 12);
    std::uniform_int_distribution<int> grid(-4096, 4096);
    const double x = step * grid(random), y = step * grid(random);
    return {x, y, x / 2 + y / 4};
}

void scale(Double3& p, int exponent) {
    p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

// Exact squares on both sides: lower^2 <= distance^2 <= upper^2.
TEST_P(PointTriangleDistanceLaws, TheIntervalHoldsTheTruth) {
    constexpr std::uint32_t kSeed = 41;
    std::mt19937 random(kSeed);
    double widest = 0;
    int face = 0;
    constexpr int kRounds = 4'000;
    for (int round = 0; round < kRounds; ++round) {
        Corners t = draw_triangle(random, GetParam());
        Double3 q = draw_point(random, GetParam(), t);
        if (round % 2 == 1 && !GetParam().sliver) {  // straight above the plane
            for (Double3& p : t) p = on_tilted_plane(random, GetParam().size);
            const double h = std::exp2(std::ilogb(GetParam().away + 0x1p-30));
            // Mostly above the triangle, sometimes far beside it.
            const double beside = GetParam().size * (round % 8 == 1 ? 8192 : 1);
            q = sum(on_tilted_plane(random, beside), {-h / 2, -h / 4, h});
        }
        for (Double3& p : t) scale(p, GetParam().exponent);
        scale(q, GetParam().exponent);
        const PointTriangleDistance found = point_triangle_distance(q, t);
        const ExactRational truth = exact_squared_distance(q, t);
        const ExactNumber lower = found.lower, upper = found.upper;
        ASSERT_LE(ExactRational(lower * lower, 1.0), truth) << "seed " << kSeed << ' ' << round;
        ASSERT_GE(ExactRational(upper * upper, 1.0), truth) << "seed " << kSeed << ' ' << round;
        ASSERT_GE(found.computed, found.lower) << round;
        ASSERT_LE(found.computed, found.upper) << round;
        widest = std::max(widest, std::ldexp(found.upper - found.lower, -GetParam().exponent));
        ExactRational corner(1e300);
        corner = corner * corner * corner;
        for (std::size_t i = 0; i < 3; ++i) {
            corner = std::min(corner, exact_squared_distance(q, {t[i], t[(i + 1) % 3], t[i]}));
        }
        face += truth < corner ? 1 : 0;
    }
    // Slivers and subnormals are less sure of themselves.
    EXPECT_LT(widest, GetParam().sliver || GetParam().exponent < -1022 ? 1e-3 : 1e-7);
    if (GetParam().exponent == 0 && !GetParam().sliver) {
        EXPECT_GT(face, kRounds / 40);
    }
}

INSTANTIATE_TEST_SUITE_P(Situations, PointTriangleDistanceLaws, testing::ValuesIn(kSituations),
                         [](const auto& situation) { return situation.param.name; });

TEST(PointTriangleDistance, OfAPointThatIsNotFiniteIsUnknown) {
    const Corners t = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double odd : {kInfinity, -kInfinity}) {
        const PointTriangleDistance found = point_triangle_distance({odd, 0, 0}, t);
        EXPECT_EQ(found.lower, 0);
        EXPECT_EQ(found.upper, kInfinity);
    }
}

}  // namespace
}  // namespace cdprep::test
