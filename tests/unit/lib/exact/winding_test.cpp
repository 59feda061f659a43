// SPDX-License-Identifier: MIT
#include "exact/winding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "support/brute_force.h"
#include "support/exact_winding.h"
#include "support/hard_points.h"
#include "support/meshes.h"

namespace cdprep::test {
namespace {

// By hand: a triangle in the plane z = 1, counter-clockwise from above.
TEST(WindingTerm, CountsLeavingAsOneAndEnteringAsMinusOne) {
    const Corners t = {{{-1, -1, 1}, {2, -1, 1}, {-1, 2, 1}}};
    EXPECT_EQ(winding_term({0, 0, -1}, {0, 0, 0}, t).crossings, 1);
    EXPECT_EQ(winding_term({0, 0, 3}, {0, 0, 2}, t).crossings, -1);
    EXPECT_EQ(winding_term({0, 0, 1.5}, {0, 0, 2}, t).crossings, 0);  // behind the ray
    EXPECT_EQ(winding_term({5, 0, -1}, {5, 0, 0}, t).crossings, 0);   // beside it
    EXPECT_EQ(winding_term({5, 0, 1}, {4, 0, 1}, t).crossings, 0);    // in its plane
    EXPECT_FALSE(winding_term({5, 0, 1}, {4, 0, 1}, t).on_surface);
    EXPECT_TRUE(winding_term({5, 0, 1}, {0, 0, 1}, t).on_surface);
}

TEST(WindingTerm, PointsOnTrianglesWithoutAreaAreOnTheSurface) {
    const Corners segment = {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}};
    EXPECT_TRUE(winding_term({5, 1, 0}, {1.5, 1.5, 1.5}, segment).on_surface);
    EXPECT_FALSE(winding_term({5, 1, 0}, {3, 3, 3}, segment).on_surface);
    EXPECT_EQ(winding_term({5, 1, 0}, {3, 3, 3}, segment).crossings, 0);
}

/// Closed by construction: the faces of tetrahedra with corners on a grid, some
/// inside out, some flat. Shared corners, edges and faces are common.
std::vector<Corners> tetrahedra(std::mt19937& random, int count, int grid) {
    std::uniform_int_distribution<int> step(-grid, grid);
    std::vector<Corners> surface;
    for (int i = 0; i < count; ++i) {
        Corners base{};
        const auto point = [&] {
            const int x = step(random), y = step(random), z = step(random);
            return Double3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        };
        for (Double3& p : base) p = point();
        const Double3 apex = point();
        surface.push_back(base);
        for (std::size_t k = 0; k < 3; ++k) surface.push_back({base[(k + 1) % 3], base[k], apex});
    }
    return surface;
}

// Rays through corners and along edges are common here, for every origin.
TEST(WindingLaws, AgreesWithRandomRaysInExactNumbers) {
    constexpr std::uint32_t kSeed = 61;
    std::mt19937 random(kSeed);
    std::uniform_int_distribution<int> step(-2, 2);
    int on_surface = 0, outside = 0, inside = 0;
    for (int round = 0; round < 1'500; ++round) {
        const std::vector<Corners> surface = tetrahedra(random, 1 + round % 4, 2);
        const Double3 q{0.5 * step(random), 0.5 * step(random), 0.5 * step(random)};
        const std::optional<int> truth = exact_winding(surface, q);
        for (int i = 0; i < 6; ++i) {
            const Double3 o{0.5 * step(random), 0.5 * step(random), 0.5 * step(random)};
            if (o == q) continue;
            ASSERT_EQ(sum_of_terms(surface, o, q), truth)
                << "seed " << kSeed << ", round " << round;
        }
        ++(!truth ? on_surface : *truth == 0 ? outside : inside);
    }
    EXPECT_GT(on_surface, 150);
    EXPECT_GT(outside, 150);
    EXPECT_GT(inside, 150);
}

TEST(WindingLaws, DoesNotDependOnOrderOrFirstCorner) {
    constexpr std::uint32_t kSeed = 62;
    std::mt19937 random(kSeed);
    int inside = 0;
    for (int round = 0; round < 500; ++round) {
        std::vector<Corners> surface = tetrahedra(random, 4, 3);
        const std::optional<int> before = sum_of_terms(surface, {0, 0, -7}, {0, 0, 0});
        inside += before && *before != 0 ? 1 : 0;
        std::shuffle(surface.begin(), surface.end(), random);
        for (Corners& t : surface) std::rotate(t.begin(), t.begin() + round % 3, t.end());
        ASSERT_EQ(sum_of_terms(surface, {0, 0, -7}, {0, 0, 0}), before) << kSeed << ' ' << round;
    }
    EXPECT_GT(inside, 30);
}

// P01: the ray from o leaves through a folded vertex, at every height.
TEST(WindingLaws, AFoldedVertexIsCountedOnce) {
    const std::vector<Corners> surface = surface_of(folded_corner());
    for (const double z : {-0.5, -0.25, -1.0, -2.0, 0.5, 3.0, -10.0}) {
        ASSERT_EQ(sum_of_terms(surface, {0, 0, -20}, {0, 0, z}), exact_winding(surface, {0, 0, z}))
            << z;
    }
    EXPECT_EQ(exact_winding(surface, {0, 0, -0.5}), 1);  // where once per sign says 0
}

// P03, P04, P05: the answer for a cube is known by hand for every half integer.
TEST(WindingLaws, ACubeAmongHalfIntegersFromItsCentre) {
    const std::vector<Corners> cube = surface_of(moved_by(unit_cube(), 2, {-1, -1, -1}));
    for (int i = 0; i < 729; ++i) {
        const Double3 q{(i % 9 - 4) / 2.0, (i / 9 % 9 - 4) / 2.0, (i / 81 - 4) / 2.0};
        const double far = std::max({std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
        const auto found =
            sum_of_terms(cube, q == Double3{0, 0, 0} ? Double3{1, 1, 1} : Double3{0, 0, 0}, q);
        ASSERT_EQ(found, far == 1 ? std::nullopt : std::optional(far < 1 ? 1 : 0)) << i;
    }
}

// P06, P07, P09 by counting.
TEST(WindingLaws, ShellsAddUp) {
    const TestMesh small = moved_by(unit_cube(), 1, {1, 1, 1});
    const TestMesh large = moved_by(unit_cube(), 3, {0, 0, 0});
    const Double3 core{1.5, 1.5, 1.5}, o{1.5, 1.5, -4};
    EXPECT_EQ(sum_of_terms(surface_of(joined(small, large)), o, core), 2);
    EXPECT_EQ(sum_of_terms(surface_of(joined(reversed(small), large)), o, core), 0);
    EXPECT_EQ(sum_of_terms(surface_of(reversed(small)), o, core), -1);
    const TestMesh beside = joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, 0}));
    EXPECT_EQ(sum_of_terms(surface_of(beside), {0.5, 0.5, -4}, {0.5, 0.5, 0.5}), 1);
    EXPECT_EQ(sum_of_terms(surface_of(beside), {1.5, 0.5, -4}, {1.5, 0.5, 0.5}), 0);
    const TestMesh shifted = joined(unit_cube(), moved_by(unit_cube(), 1, {0.5, 0.5, 0.5}));
    EXPECT_EQ(sum_of_terms(surface_of(shifted), {0.75, 0.75, -4}, {0.75, 0.75, 0.75}), 2);
}

// The definition of the winding number by angles, away from the surface.
TEST(SolidAngle, AddsUpToTheWindingNumber) {
    constexpr std::uint32_t kSeed = 63;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> component(-2, 2);
    for (const int exponent : {0, -1000, 900}) {
        int inside = 0;
        for (int round = 0; round < 300; ++round) {
            std::vector<Corners> surface = tetrahedra(random, 3, 2);
            const double scale = std::ldexp(1.0, exponent);
            for (Corners& t : surface) {
                for (Double3& p : t) p = {scale * p.x, scale * p.y, scale * p.z};
            }
            const double x = component(random), y = component(random), z = component(random);
            const Double3 q{scale * x, scale * y, scale * z};
            double angle = 0;
            for (const Corners& t : surface) angle += solid_angle(q, t);
            const auto exact = sum_of_terms(surface, {scale * 9, scale * 8, scale * 7}, q);
            ASSERT_TRUE(exact);
            ASSERT_NEAR(angle / (4 * std::numbers::pi), *exact, 1e-9) << kSeed << ' ' << round;
            inside += *exact != 0 ? 1 : 0;
        }
        EXPECT_GT(inside, 8) << exponent;
    }
}

// P08: by symmetry one face of six seen from the centre is a sixth.
TEST(SolidAngle, AnOpenCubeIsFiveSixthsAtItsCentre) {
    TestMesh open = unit_cube();
    open.triangles.resize(10);
    double angle = 0;
    for (const Corners& t : surface_of(open)) angle += solid_angle({0.5, 0.5, 0.5}, t);
    EXPECT_NEAR(angle / (4 * std::numbers::pi), 5.0 / 6, 1e-14);
}

}  // namespace
}  // namespace cdprep::test
