// SPDX-License-Identifier: MIT
#include "exact/ray_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "support/exact_contact.h"
#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

ExactPoint<ExactNumber> exact_point(const Double3& p) {
    return {p.x, p.y, p.z};
}

/// Where the line meets the triangle's plane, in directions; nothing if they are parallel.
std::optional<ExactRational> exact_place(const HalfLine& ray, const Corners& t) {
    const ExactTriangle<ExactNumber> c = exact<ExactNumber>(t);
    const auto n = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    const ExactNumber along = dot(n, exact_point(ray.direction));
    if (along.sign() == 0) return std::nullopt;
    return ExactRational(dot(n, minus(c[0], exact_point(ray.origin))), along);
}

/// Returns the ray with a step of 2^exponent directions. Its places count steps.
HalfLine with_step(const HalfLine& ray, int exponent) {
    const Double3& d = ray.direction;
    return {ray.origin,
            d,
            {std::ldexp(d.x, exponent), std::ldexp(d.y, exponent), std::ldexp(d.z, exponent)},
            exponent};
}

/// Returns the steps of 2^exponent in a place that counts directions.
ExactRational in_steps(const ExactRational& place, int exponent) {
    return place * ExactRational(std::ldexp(1.0, -exponent));
}

/// The bound of the public header: within 2^-40 of the exact place.
void expect_place(double found, const ExactRational& truth, const std::string& where) {
    const ExactRational off = ExactRational(found) - truth;
    const ExactRational limit = truth * ExactRational(0x1p-40);
    EXPECT_TRUE(off <= limit && ExactRational(0.0) - limit <= off)
        << where << ": " << found << " instead of " << truth.approximation();
}

/// A half-line and a triangle near its way.
struct Case {
    HalfLine ray;
    Corners t;
};

Double3 between(const Corners& t, double s, double r) {
    const auto along = [&](double a, double b, double c) { return a + s * (b - a) + r * (c - a); };
    return {along(t[0].x, t[1].x, t[2].x), along(t[0].y, t[1].y, t[2].y),
            along(t[0].z, t[1].z, t[2].z)};
}

/// Returns the ray from o through about p. The step is the direction.
HalfLine through(const Double3& o, const Double3& p) {
    const Double3 d = {p.x - o.x, p.y - o.y, p.z - o.z};
    return {o, d, d};
}

Double3 random_corner(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> fine(-size, size);
    const double x = fine(random), y = fine(random), z = fine(random);
    return {x, y, z};
}

/// Everything lies in a tilted plane, up to rounding.
Case grazing(std::mt19937& random) {
    const Double3 tilt = random_corner(random, 1);
    const auto on_plane = [&](double size) {
        const Double3 p = random_corner(random, size);
        return Double3{p.x, p.y, tilt.x * p.x + tilt.y * p.y + tilt.z};
    };
    const Corners t = {on_plane(1), on_plane(1), on_plane(1)};
    const Double3 aim = between(t, 0.25, 0.25);
    const Double3 o = on_plane(3);
    return {through(o, {aim.x, aim.y, tilt.x * aim.x + tilt.y * aim.y + tilt.z}), t};
}

/// The third corner lies on the opposite edge, up to rounding.
Case at_a_sliver(std::mt19937& random) {
    Corners t = {random_corner(random, 1), random_corner(random, 1), {}};
    t[2] = between(t, 0.4, 0);
    return {through(random_corner(random, 3), between(t, 0.3, 0)), t};
}

/// The origin lies on the triangle, up to rounding or a little more.
Case leaving(std::mt19937& random) {
    const Corners t = {random_corner(random, 1), random_corner(random, 1),
                       random_corner(random, 1)};
    Double3 o = between(t, 0.3, 0.3);
    if (random() % 2 == 0) o.z += 1e-9;
    return {through(o, random_corner(random, 3)), t};
}

struct RayFamily {
    const char* name;
    Case (*draw)(std::mt19937&);

    friend std::ostream& operator<<(std::ostream& stream, const RayFamily& family) {
        return stream << family.name;
    }
};

class RayTriangleLaws : public ::testing::TestWithParam<RayFamily> {};

Case scaled_case(const Case& c, int exponent) {
    const auto at = [&](const Double3& p) {
        return Double3{std::ldexp(p.x, exponent), std::ldexp(p.y, exponent),
                       std::ldexp(p.z, exponent)};
    };
    return {{at(c.ray.origin), at(c.ray.direction), at(c.ray.step)},
            {at(c.t[0]), at(c.t[1]), at(c.t[2])}};
}

// The oracle: a quotient of two exact volumes.
TEST_P(RayTriangleLaws, ThePlaceIsWithinItsBound) {
    std::mt19937 random(20261130);
    int hits = 0;
    constexpr int kRounds = 3000;
    for (int round = 0; round < kRounds; ++round) {
        const Case drawn = GetParam().draw(random);
        for (const int exponent : {0, -1000, 900}) {
            const Case c = scaled_case(drawn, exponent);
            const std::optional<double> found = ray_triangle(c.ray, c.t);
            const std::optional<ExactRational> truth = exact_place(c.ray, c.t);
            if (!found || !truth) continue;
            hits += exponent == 0 ? 1 : 0;
            const std::string where = "seed 20261130, round " + std::to_string(round);
            expect_place(*found, *truth, where);
            for (const int step : {-7, 60}) {
                const std::optional<double> steps = ray_triangle(with_step(c.ray, step), c.t);
                ASSERT_TRUE(steps) << where;
                expect_place(*steps, in_steps(*truth, step), where);
            }
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(hits, kRounds / 20);
}

INSTANTIATE_TEST_SUITE_P(Situations, RayTriangleLaws,
                         ::testing::Values(RayFamily{"grazing", &grazing},
                                           RayFamily{"at_a_sliver", &at_a_sliver},
                                           RayFamily{"leaving", &leaving}),
                         [](const auto& given) { return given.param.name; });

/// A point of a plane in the coordinates of the plane; both are integers.
struct Planar {
    double i;
    double j;
};

ExactNumber turn(const Planar& a, const Planar& b) {
    return ExactNumber(a.i) * ExactNumber(b.j) - ExactNumber(a.j) * ExactNumber(b.i);
}

Planar minus(const Planar& a, const Planar& b) {
    return {a.i - b.i, a.j - b.j};  // exact for these integers
}

/// Offers the places, at least 0, where the line from o along d meets an edge. d is not parallel to
/// the edge.
void offer_edge(const Planar& o, const Planar& d, const Planar& u, const Planar& v,
                std::optional<ExactRational>& first) {
    if (turn(d, minus(u, o)).sign() * turn(d, minus(v, o)).sign() > 0) return;
    const Planar edge = minus(v, u);
    const ExactRational place(turn(minus(u, o), edge), turn(d, edge));
    if (place.sign() >= 0 && (!first || place < *first)) first = place;
}

// The oracle: exact numbers in the coordinates of the plane. An edge runs nearly along the ray, and
// crosses it slowly.
TEST(RayTriangleLaws, InThePlaneThePlaceIsWithinItsBoundToo) {
    std::mt19937 random(20261131);
    const auto integer = [&](double most) {
        return std::round(std::uniform_real_distribution<double>(-most, most)(random));
    };
    int hits = 0, tested = 0;
    for (int round = 0; round < 3000; ++round) {
        const Double3 along_i = {integer(3), integer(3), 1}, along_j = {integer(3), 1, 0};
        const auto in_space = [&](const Planar& p) {
            return Double3{p.i * along_i.x + p.j * along_j.x, p.i * along_i.y + p.j * along_j.y,
                           p.i * along_i.z + p.j * along_j.z};
        };
        const Planar o = {integer(0x1p40), integer(0x1p40)};
        const Planar d = {integer(0x1p26), integer(0x1p26)};
        const auto beside = [&] {
            const double steps = std::fabs(integer(0x1p13));
            return Planar{o.i + steps * d.i + integer(9), o.j + steps * d.j + integer(9)};
        };
        const std::array<Planar, 3> p = {beside(), beside(),
                                         Planar{integer(0x1p40), integer(0x1p40)}};
        if (turn(d, minus(p[1], p[0])).sign() == 0 || turn(d, minus(p[2], p[1])).sign() == 0 ||
            turn(d, minus(p[0], p[2])).sign() == 0) {
            continue;
        }
        std::optional<ExactRational> first;
        for (std::size_t k = 0; k < 3; ++k) offer_edge(o, d, p[k], p[(k + 1) % 3], first);
        const Double3 step = in_space(d);
        const Corners t = {in_space(p[0]), in_space(p[1]), in_space(p[2])};
        const std::optional<double> found = ray_triangle({in_space(o), step, step}, t);
        const bool inside = triangles_touch({in_space(o), in_space(o), in_space(o)}, t);
        ASSERT_EQ(found.has_value(), first.has_value() || inside) << "round " << round;
        ++tested;
        if (!found || inside) continue;
        ++hits;
        const std::string where = "seed 20261131, round " + std::to_string(round);
        expect_place(*found, *first, where);
        for (const int exponent : {-7, 60}) {
            const std::optional<double> steps =
                ray_triangle(with_step({in_space(o), step, step}, exponent), t);
            ASSERT_TRUE(steps) << where;
            expect_place(*steps, in_steps(*first, exponent), where);
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(hits, tested * 3 / 10) << tested;
    EXPECT_LT(hits, tested * 8 / 10) << tested;
}

// By hand: the ray rises by 7/2 of 2^-1074 per step, and the triangle lies 2^-1074 above its
// origin. So the exact place is 2/7 of a step. The rounded step rises by 4 of 2^-1074.
TEST(RayTriangle, ARoundedStepDoesNotMoveThePlace) {
    const double least = 0x1p-1074;
    const HalfLine ray = {{0, 0, 0}, {0x1p900, 0, 7 * 0x1p-177}, {4, 0, 4 * least}, -898};
    const Corners t = {{{1, -9, least}, {9, 0, least}, {1, 9, least}}};
    ASSERT_TRUE(ray_triangle(ray, t));
    EXPECT_DOUBLE_EQ(*ray_triangle(ray, t), 2.0 / 7);
}

}  // namespace
}  // namespace cdprep::test
