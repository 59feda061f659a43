// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "exact/exact_common_point.h"
#include "exact/triangle_distance.h"
#include "exact/vectors.h"
#include "support/exact_distance.h"

namespace cdprep::test {
namespace {

struct Two {
    Corners a;
    Corners b;
};

Double3 random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> fine(-size, size);
    const double x = fine(random), y = fine(random), z = fine(random);
    return {x, y, z};
}

Double3 between(const Double3& p, const Double3& q, double s) {
    return p + s * (q - p);
}

/// A triangle whose third corner is about `away` from the opposite edge.
Corners thin(std::mt19937& random, const Double3& p, const Double3& q, double away) {
    return {p, q, between(p, q, 0.4) + random_point(random, away)};
}

/// Both lie in one plane up to `height`, and one is thin.
Two nearly_coplanar(std::mt19937& random) {
    const Double3 tilt = random_point(random, 1);
    const double height = std::ldexp(1.0, -static_cast<int>(random() % 60));
    const auto on_plane = [&] {
        const Double3 p = random_point(random, 1);
        return Double3{p.x, p.y, tilt.x * p.x + tilt.y * p.y + height * p.z};
    };
    const double away = std::ldexp(1.0, -10 - static_cast<int>(random() % 60));
    return {{on_plane(), on_plane(), on_plane()}, thin(random, on_plane(), on_plane(), away)};
}

/// Integers in one plane; slivers among them.
Two coplanar(std::mt19937& random) {
    std::uniform_int_distribution<int> place(-(1 << 25), 1 << 25), slope(-50, 50);
    const double x = slope(random), y = slope(random);
    const auto on_plane = [&](double at_x, double at_y) {
        return Double3{at_x, at_y, x * at_x + y * at_y};
    };
    const auto triangle = [&] {
        const double px = place(random), py = place(random), qx = place(random), qy = place(random);
        const Double3 m = between({px, py, 0}, {qx, qy, 0}, 0.5);
        return Corners{on_plane(px, py), on_plane(qx, qy),
                       on_plane(std::round(m.x), std::round(m.y))};
    };
    return {triangle(), triangle()};
}

Two coplanar_segments(std::mt19937& random) {
    Two two = coplanar(random);
    two.a[2] = two.a[1];
    two.b[2] = two.b[0];
    return two;
}

Two segment_and_sliver(std::mt19937& random) {
    const Double3 p = random_point(random, 1), q = random_point(random, 1);
    const Corners sliver = thin(random, random_point(random, 1), random_point(random, 1), 0.01);
    const Double3 aim = between(between(sliver[0], sliver[1], 0.3), sliver[2], 0.1);
    return {{p, between(p, aim, 2), q.x > 0 ? p : between(p, aim, 2)}, sliver};
}

struct Family {
    const char* name;
    Two (*draw)(std::mt19937&);

    friend std::ostream& operator<<(std::ostream& stream, const Family& family) {
        return stream << family.name;
    }
};

class CommonPointLaws : public ::testing::TestWithParam<Family> {};

/// Returns whether the triangle is at most `distance` from p. The oracle: rational arithmetic.
bool is_near(const Double3& p, const Corners& t, double distance) {
    return exact_squared_distance(p, t) <= exact_square(distance);
}

TEST_P(CommonPointLaws, LiesOnBothUpToRounding) {
    std::mt19937 random(20261133);
    int touching = 0;
    for (int round = 0; round < 4000 && touching < 600; ++round) {
        const auto [a, b] = GetParam().draw(random);
        const std::optional<Double3> exact = exact_common_point(a, b);
        ASSERT_EQ(exact.has_value(), triangles_touch(a, b)) << "round " << round;
        if (!exact) continue;
        ++touching;
        double size = 0;
        for (const Double3& p : {a[0], a[1], a[2], b[0], b[1], b[2]}) {
            size = std::max(size, largest_of(p));
        }
        const Double3 point = common_point(a, b);
        ASSERT_TRUE(is_near(point, a, 0x1p-46 * size)) << "seed 20261133, round " << round;
        ASSERT_TRUE(is_near(point, b, 0x1p-46 * size)) << "seed 20261133, round " << round;
        ASSERT_TRUE(is_near(*exact, a, 0x1p-52 * size)) << "seed 20261133, round " << round;
        ASSERT_TRUE(is_near(*exact, b, 0x1p-52 * size)) << "seed 20261133, round " << round;
    }
    EXPECT_GE(touching, 200);
}

INSTANTIATE_TEST_SUITE_P(Situations, CommonPointLaws,
                         ::testing::Values(Family{"nearly_coplanar", &nearly_coplanar},
                                           Family{"coplanar", &coplanar},
                                           Family{"coplanar_segments", &coplanar_segments},
                                           Family{"segment_and_sliver", &segment_and_sliver}),
                         [](const auto& given) { return given.param.name; });

// By hand: two thin triangles that cross nearly in one plane. In double, the point was 2.5e-9 off.
TEST(CommonPoint, OfThinTrianglesLiesOnBoth) {
    const Corners a = {{{-0.97199368234429118, 0.98277221979809215, 0.084869409885834676},
                        {0.73031974237410568, -0.97515106084089043, -0.29896154562936594},
                        {0.28810704777661633, -0.46653818310966533, -0.19925316135437021}}};
    const Corners b = {{{-0.69829628842365588, -0.39576491417976378, -1.0336707912987393},
                        {0.92688034098364236, 0.39425130772601968, 1.2418247100248105},
                        {0.56346514126332381, 0.21759119613609779, 0.73298792168854232}}};
    ASSERT_TRUE(triangles_touch(a, b));
    const Double3 point = common_point(a, b);
    EXPECT_TRUE(is_near(point, a, 1e-15));
    EXPECT_TRUE(is_near(point, b, 1e-15));
}

// By hand: the first triangle lies in the second. Differences of their corners overflow.
TEST(CommonPoint, OfTrianglesOfAnySizeIsFinite) {
    const Corners a = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const double far = 1e308;
    const Corners b = {{{-far, -far, 0}, {far, -far, 0}, {0, far, 0}}};
    for (const Double3& point : {common_point(a, b), common_point(b, a)}) {
        EXPECT_TRUE(point.x >= 0 && point.y >= 0 && point.x + point.y <= 1);
        EXPECT_EQ(point.z, 0);
    }
}

}  // namespace
}  // namespace cdprep::test
