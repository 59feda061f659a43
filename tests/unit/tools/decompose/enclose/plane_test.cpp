// SPDX-License-Identifier: MIT
#include "decompose/enclose/plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"

namespace cdprep::convex {
namespace {

using mesh::cross;
using mesh::dot;
using mesh::minus;

Double3 rounded_normal(const Double3& a, const Double3& b, const Double3& c) {
    const Double3 n = cross(minus(b, a), minus(c, a));
    return mesh::scaled(n, 1 / std::sqrt(dot(n, n)));
}

TEST(ExactPlane, OfACoordinatePlaneIsExact) {
    const Plane plane = exact_plane({0, 0, 3}, {2, 0, 3}, {0, 1, 3});
    EXPECT_EQ(plane.normal.x, 0);
    EXPECT_EQ(plane.normal.y, 0);
    EXPECT_EQ(plane.normal.z, 1);
    EXPECT_EQ(plane.offset, 3);
}

TEST(ExactPlane, OfCollinearCornersHasNoDirection) {
    const Plane plane = exact_plane({0, 0, 0}, {1, 1, 1}, {3, 3, 3});
    EXPECT_EQ(dot(plane.normal, plane.normal), 0);
}

// orient3d() is the oracle: it is exact. Points on a sphere of radius 1 around the triangle lie on
// the side that the plane says, unless they are very near it.
TEST(ExactPlaneLaws, EveryPointIsOnTheSideThatExactSignsSay) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> share(0.2, 0.8);
    int wrong_if_rounded = 0;
    int compared = 0;
    for (int round = 0; round < 2'000; ++round) {
        const Double3 a = {normal(random), normal(random), normal(random)};
        const Double3 c = {normal(random), normal(random), normal(random)};
        const double s = share(random);
        // Collinear up to rounding; every other time off by some of the last digits.
        const double off = round % 2 == 0 ? 0 : std::ldexp(normal(random), -(round % 50));
        const Double3 b = {a.x + s * (c.x - a.x), a.y + s * (c.y - a.y) + off,
                           a.z + s * (c.z - a.z)};
        if (exact::is_degenerate({a, b, c})) continue;
        const Plane plane = exact_plane(a, b, c);
        EXPECT_NEAR(dot(plane.normal, plane.normal), 1, 1e-15);
        const Double3 rounded = rounded_normal(a, b, c);
        for (int i = 0; i < 10; ++i) {
            const Double3 p = {a.x + normal(random), a.y + normal(random), a.z + normal(random)};
            const int behind = exact::orient3d(a, b, c, p);
            const double above = height(plane, p);
            if (std::fabs(above) < 1e-12) continue;
            ++compared;
            EXPECT_EQ(above<0, behind> 0) << round << ": " << above;
            if ((dot(rounded, minus(p, a)) < 0) != (behind > 0)) ++wrong_if_rounded;
        }
    }
    EXPECT_GT(compared, 15'000);
    EXPECT_GT(wrong_if_rounded, 1'000);
}

}  // namespace
}  // namespace cdprep::convex
