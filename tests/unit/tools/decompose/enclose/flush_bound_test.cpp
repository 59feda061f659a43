// SPDX-License-Identifier: MIT
#include "decompose/enclose/flush_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <vector>

namespace cdprep::convex {
namespace {

using mesh::Mesh;

void add_box(Mesh& mesh, const Double3& low, const Double3& high, bool inwards) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (unsigned k = 0; k < 8; ++k) {
        mesh.positions.push_back({(k & 1U) == 0 ? low.x : high.x, (k & 2U) == 0 ? low.y : high.y,
                                  (k & 4U) == 0 ? low.z : high.z});
    }
    for (const auto& [a, b, c] : std::vector<std::array<std::uint32_t, 3>>{{0, 2, 3},
                                                                           {0, 3, 1},
                                                                           {4, 5, 7},
                                                                           {4, 7, 6},
                                                                           {0, 1, 5},
                                                                           {0, 5, 4},
                                                                           {2, 6, 7},
                                                                           {2, 7, 3},
                                                                           {0, 4, 6},
                                                                           {0, 6, 2},
                                                                           {1, 3, 7},
                                                                           {1, 7, 5}}) {
        mesh.triangles.push_back({{n + a, inwards ? n + c : n + b, inwards ? n + b : n + c}});
    }
}

ConvexHull box(const Double3& low, const Double3& high) {
    Mesh mesh;
    add_box(mesh, low, high, false);
    return convex_hull(mesh.positions);
}

/// A cube of side 4 with a cavity of side 2 in its middle.
Mesh hollow_cube() {
    Mesh mesh;
    add_box(mesh, {0, 0, 0}, {4, 4, 4}, false);
    add_box(mesh, {1, 1, 1}, {3, 3, 3}, true);
    return mesh;
}

// The slabs beside the cavity are flush with it, with the outside, or with neither.
TEST(FlushBound, OfPartsOfASolidIsWhatRoundingDoes) {
    const Solid solid(hollow_cube(), Reference::solid, serial_for);
    for (const ConvexHull& part : {box({0, 0, 0}, {4, 4, 1}), box({0, 0, 0}, {1, 4, 4}),
                                   box({3.2, 0.1, 0.1}, {3.9, 2, 3}), box({3, 1, 1}, {4, 3, 3})}) {
        const auto bound = bound_flush(part, solid, 1e-9);
        ASSERT_TRUE(bound);
        EXPECT_LE(*bound, 1e-9);
    }
}

// A tenth out of the solid, or into its cavity; around the cavity; in it; outside.
TEST(FlushBound, IsNothingForWhatSticksOut) {
    const Solid solid(hollow_cube(), Reference::solid, serial_for);
    for (const ConvexHull& part :
         {box({0, 0, 0}, {4, 4, 1.1}), box({0, 0, -0.1}, {4, 4, 1}), box({0, 0, 0}, {4, 4, 4}),
          box({1.1, 1.1, 1.1}, {2.9, 2.9, 2.9}), box({1, 1, 1}, {3, 3, 3}),
          box({5, 0, 0}, {6, 1, 1}), box({4, 0, 0}, {5, 1, 1})}) {
        EXPECT_FALSE(bound_flush(part, solid, 1e-9));
    }
}

// Open needles that reach from a side to the middle. The rounded normal of some points along them,
// so that no corner of the hull seems to be in front.
TEST(FlushBound, IsNothingForNeedlesThatGoDeep) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> share(0.2, 0.8);
    for (int round = 0; round < 300; ++round) {
        Mesh mesh;
        add_box(mesh, {0, 0, 0}, {4, 4, 4}, false);
        const Double3 from = {0, 1 + share(random), 1 + share(random)};
        const Double3 to = {2, from.y + 0.3 * share(random), from.z + 0.3 * share(random)};
        const double s = share(random);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(from);
        mesh.positions.push_back(
            {2 * s, from.y + s * (to.y - from.y), from.z + s * (to.z - from.z)});
        mesh.positions.push_back(to);
        mesh.triangles.push_back({{first, first + 1, first + 2}});
        const Solid solid(mesh, Reference::solid, serial_for);
        EXPECT_FALSE(bound_flush(box({0, 0, 0}, {4, 4, 4}), solid, 1e-9)) << round;
    }
}

// By 0.001 into the cavity: the middle of that is 0.0005 from the solid on either side, and
// every point of the hull nearer than the bound says.
TEST(FlushBound, HoldsWhereTheSurfaceIsNotDeep) {
    const Solid solid(hollow_cube(), Reference::solid, serial_for);
    const auto bound = bound_flush(box({0, 0, 0}, {4, 4, 1.001}), solid, 0.01);
    ASSERT_TRUE(bound);
    EXPECT_GE(*bound, 0.001);
    EXPECT_LE(*bound, 0.01);
}

TEST(FlushBound, IsNothingWithoutASolidOrVolume) {
    Mesh open = hollow_cube();
    open.triangles.pop_back();
    open.triangles.erase(open.triangles.begin());
    const ConvexHull part = box({0, 0, 0}, {4, 4, 1});
    EXPECT_FALSE(bound_flush(part, Solid(open, Reference::solid, serial_for), 1e-9));
    const Solid solid(hollow_cube(), Reference::solid, serial_for);
    EXPECT_FALSE(bound_flush(convex_hull({{{0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5}}}), solid, 1e-9));
}

// As far from the surface as can be, but of 5,996 facets over 3,000 corners.
TEST(FlushBound, IsNothingForHullsTooLargeToLookAt) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<Double3> points(3000);
    for (Double3& p : points) {
        const Double3 away = {normal(random), normal(random), normal(random)};
        const double share = 0.5 / std::hypot(away.x, away.y, away.z);
        p = {2 + share * away.x, 2 + share * away.y, 2 + share * away.z};
    }
    Mesh cube;
    add_box(cube, {0, 0, 0}, {4, 4, 4}, false);
    const Solid solid(cube, Reference::solid, serial_for);
    const std::span<const Double3> all(points);
    EXPECT_TRUE(bound_flush(convex_hull(all.first(1000)), solid, 1e-9));
    EXPECT_FALSE(bound_flush(convex_hull(all), solid, 1e-9));
}

}  // namespace
}  // namespace cdprep::convex
