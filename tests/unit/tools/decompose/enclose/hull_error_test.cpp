// SPDX-License-Identifier: MIT
#include "decompose/enclose/hull_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "decompose/enclose/is_convex.h"
#include "mesh/vectors.h"
#include "support/concave_solids.h"
#include "unit/tools/soup_of.h"

#include "exact/point_triangle_distance.h"

namespace cdprep::convex {
namespace {

using mesh::Mesh;
using test::mesh_of;

HullError error_of(const ConvexHull& hull, const Mesh& mesh, const HullErrorOptions& options = {},
                   Reference reference = Reference::solid) {
    return find_hull_error(hull, Solid(mesh, reference, serial_for), options);
}

HullError error_of_own_hull(const Mesh& mesh, const HullErrorOptions& options = {},
                            Reference reference = Reference::solid) {
    return error_of(convex_hull(mesh.positions), mesh, options, reference);
}

/// A ball of radius 1 with one vertex pushed in by `depth`.
Mesh dented_ball(double depth) {
    Mesh mesh = mesh_of(test::icosphere(3));
    Double3& p = mesh.positions[0];
    p = {p.x * (1 - depth), p.y * (1 - depth), p.z * (1 - depth)};
    return mesh;
}

// In the notch the point farthest from both walls is half a side from each.
TEST(HullError, OfAnLPrismIsHalfASide) {
    const HullError error = error_of_own_hull(mesh_of(test::l_prism()));
    EXPECT_NEAR(error.lower, 0.5, 0.02);
    EXPECT_GE(error.upper, 0.5);
    EXPECT_LE(error.upper, 0.5 * 1.05);
    EXPECT_NEAR(error.worst.x, 1.5, 0.05);
    EXPECT_NEAR(error.worst.y, 1.5, 0.05);
}

// The middle of a cavity is half its side from the walls, and nothing on the hull's own
// surface tells of it.
TEST(HullError, TellsOfCavities) {
    const Mesh hollow = mesh_of(test::joined(test::moved_by(test::unit_cube(), 3, {-1, -1, -1}),
                                             test::reversed(test::unit_cube())));
    const HullError error = error_of_own_hull(hollow);
    EXPECT_NEAR(error.lower, 0.5, 0.02);
    EXPECT_GE(error.upper, 0.5);
    EXPECT_LE(error.upper, 0.5 * 1.1);
}

/// A square prism, turned by an angle and with slanted ends, with a cavity of side 6 in it. Each
/// side of the square is cut in eight. Rounding makes cut points corners of the hull, and facets
/// slivers.
Mesh turned_prism_with_a_cavity(double angle) {
    constexpr std::uint32_t kCuts = 8;
    constexpr double kHeight = 14;
    Mesh mesh;
    for (const double z : {0.0, kHeight}) {
        for (int side = 0; side < 4; ++side) {
            const double from = angle + side * std::acos(0), to = from + std::acos(0);
            for (std::uint32_t i = 0; i < kCuts; ++i) {
                const double share = i / double{kCuts};
                const double x = 10 * std::cos(from), y = 10 * std::sin(from);
                Double3 p = {x + (10 * std::cos(to) - x) * share,
                             y + (10 * std::sin(to) - y) * share, z};
                p.z += 0.1 * p.x;
                mesh.positions.push_back(p);
            }
        }
    }
    constexpr std::uint32_t kAround = 4 * kCuts;
    mesh.positions.push_back({0, 0, 0});
    mesh.positions.push_back({0, 0, kHeight});
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const std::uint32_t next = (i + 1) % kAround;
        mesh.triangles.push_back({{i, next, kAround + next}});
        mesh.triangles.push_back({{i, kAround + next, kAround + i}});
        mesh.triangles.push_back({{2 * kAround + 1, kAround + i, kAround + next}});
        mesh.triangles.push_back({{2 * kAround, next, i}});
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const test::TestMesh cavity = test::reversed(test::moved_by(test::unit_cube(), 6, {-3, -3, 4}));
    mesh.positions.insert(mesh.positions.end(), cavity.positions.begin(), cavity.positions.end());
    for (const auto& t : cavity.triangles) {
        mesh.triangles.push_back({{first + t.vertex[0], first + t.vertex[1], first + t.vertex[2]}});
    }
    return mesh;
}

/// Counts facets in front of whose rounded plane some corner of the hull lies.
int count_wrong_planes(const ConvexHull& hull) {
    int wrong = 0;
    for (const auto& f : hull.facets) {
        const Double3& a = hull.points[f[0]];
        const Double3 n =
            mesh::cross(mesh::minus(hull.points[f[1]], a), mesh::minus(hull.points[f[2]], a));
        const double length = std::sqrt(mesh::dot(n, n));
        double most = 0;
        for (const Double3& p : hull.points) {
            most = std::max(most, mesh::dot(n, mesh::minus(p, a)) / length);
        }
        wrong += most > 1e-6 ? 1 : 0;
    }
    return wrong;
}

// The middle of the cavity is 3 from its walls.
TEST(HullError, TellsOfCavitiesBehindSliversOfTheHull) {
    int wrong_planes = 0;
    for (int i = 0; i < 12; ++i) {
        const Mesh hollow = turned_prism_with_a_cavity(0.5 * i + 0.01);
        wrong_planes += count_wrong_planes(convex_hull(hollow.positions));
        const HullError error = error_of_own_hull(hollow, {.relative = 0.05});
        EXPECT_GE(error.upper, 3) << i;
        EXPECT_LE(error.upper, 3.3) << i;
        EXPECT_LE(error.lower, 3 + 1e-9) << i;
    }
    EXPECT_GT(wrong_planes, 20);
}

// A plate as thin as a few roundings, 8 wide: its rim has facets without a direction in double.
// Nothing sticks out, and no point beyond the rim counts.
TEST(HullError, OfATurnedSheetEndsAtItsRim) {
    for (int i = 0; i < 20; ++i) {
        const double angle = 0.3 * i + 0.1;
        Mesh sheet;
        for (int y = 0; y <= 8; ++y) {
            for (int x = 0; x <= 8; ++x) {
                sheet.positions.push_back(
                    {x + 0.3 * y, std::cos(angle) * y - 0.1 * x, std::sin(angle) * y + 0.7 * x});
            }
        }
        for (std::uint32_t y = 0; y < 8; ++y) {
            for (std::uint32_t x = 0; x < 8; ++x) {
                const std::uint32_t at = 9 * y + x;
                sheet.triangles.push_back({{at, at + 1, at + 10}});
                sheet.triangles.push_back({{at, at + 10, at + 9}});
            }
        }
        EXPECT_LE(error_of_own_hull(sheet, {.enough = 0.5}).upper, 0.6) << i;
    }
}

// The middle of a box without an inside is half its shortest side from the surface.
TEST(HullError, FromTheSurfaceCountsTheInside) {
    Mesh mesh = mesh_of(test::unit_cube());
    for (Double3& p : mesh.positions) p.z *= 0.5;
    const HullError error = error_of_own_hull(mesh, {}, Reference::surface);
    EXPECT_NEAR(error.lower, 0.25, 0.01);
    EXPECT_GE(error.upper, 0.25);
    EXPECT_LE(error.upper, 0.25 * 1.1);
    EXPECT_LE(error_of_own_hull(mesh, {.enough = 1e-3}).upper, 2e-3);
}

// A hull around a dented ball sticks out by no more than the dent is deep, however shallow.
TEST(HullError, OfWhatIsAllButConvexIsAsSmallAsItsDent) {
    for (const double depth : {0.1, 1e-2, 1e-3, 1e-5, 1e-9}) {
        const Mesh mesh = dented_ball(depth);
        const double enough = 1e-3;
        const HullError error = error_of_own_hull(mesh, {.enough = enough});
        EXPECT_LE(error.lower, depth + 1e-12) << depth;
        EXPECT_LE(error.upper, 2 * std::max(depth, enough)) << depth;
        EXPECT_GT(error.upper, 0.0) << depth;
    }
}

// The winding number around a point is -1: that is inside, too.
TEST(HullError, OfASolidInsideOutIsThatOfTheSolid) {
    const Mesh mesh = mesh_of(test::reversed(test::icosphere(2)));
    EXPECT_LE(error_of_own_hull(mesh, {.enough = 1e-3}).upper, 2e-3);
    std::vector<std::uint32_t> all(mesh.triangles.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    const ConvexHull hull = convex_hull(mesh.positions);
    EXPECT_TRUE(is_convex(mesh, all, hull));
    EXPECT_TRUE(is_convex(mesh_of(test::icosphere(2)), all, hull));
    Mesh one_turned = mesh;
    std::swap(one_turned.triangles[7].vertex[0], one_turned.triangles[7].vertex[1]);
    EXPECT_FALSE(is_convex(one_turned, all, hull));
    EXPECT_FALSE(is_convex(dented_ball(0.1), all, hull));
}

// What is far too large is not measured: bounds still hold, with less work.
TEST(HullError, EndsEarlyWhereItIsTooMuch) {
    const HullError all = error_of_own_hull(mesh_of(test::l_prism()));
    const HullError early = error_of_own_hull(mesh_of(test::l_prism()), {.too_much = 0.1});
    EXPECT_GT(early.lower, 0.1);
    EXPECT_GE(early.upper, 0.5);
    EXPECT_LT(early.cells, all.cells);
}

TEST(HullError, OfPointsAndSegmentsIsTheirDistance) {
    const Mesh cube = mesh_of(test::unit_cube());
    const std::array<Double3, 1> point = {{{0.5, 0.5, 3}}};
    const HullError of_point = error_of(convex_hull(point), cube);
    EXPECT_NEAR(of_point.upper, 2, 1e-9);
    EXPECT_NEAR(of_point.lower, 2, 1e-9);
    const std::array<Double3, 2> segment = {{{0.5, 0.5, 0.5}, {0.5, 0.5, 2}}};
    const HullError of_segment = error_of(convex_hull(segment), cube);
    EXPECT_GE(of_segment.upper, 1);
    EXPECT_LE(of_segment.upper, 1.05);
    EXPECT_EQ(error_of({}, cube).upper, 0.0);
}

/// The distance from the surface by looking at every triangle.
double surface_distance(const Mesh& mesh, const Double3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& t : mesh.triangles) {
        const Corners corners = {mesh.positions[t.vertex[0]], mesh.positions[t.vertex[1]],
                                 mesh.positions[t.vertex[2]]};
        least = std::min(least, point_triangle_distance(p, corners).upper);
    }
    return least;
}

// Powers of two change exponents alone, until numbers are subnormal. Then bounds go outwards.
TEST(HullError, OfAMeshOfAnySizeIsThatOfSizeOne) {
    for (const test::TestMesh& test_mesh : {test::l_prism(), test::unit_cube()}) {
        const Mesh mesh = mesh_of(test_mesh);
        for (const Reference reference : {Reference::solid, Reference::surface}) {
            const HullError plain = error_of_own_hull(mesh, {}, reference);
            for (const int exponent : {-1073, -1060, -700, -500, 0, 500, 700, 999}) {
                const Mesh scaled = mesh_of(test::moved_by(test_mesh, std::ldexp(1, exponent), {}));
                const HullError error =
                    find_hull_error(convex_hull(scaled.positions), scaled, reference, serial_for);
                const double unit = exponent < -1000 ? 0x1p-1074 : 0;
                EXPECT_GE(error.upper, std::ldexp(plain.upper, exponent)) << exponent;
                EXPECT_LE(error.upper, std::ldexp(plain.upper, exponent) + unit) << exponent;
                EXPECT_LE(error.lower, std::ldexp(plain.lower, exponent)) << exponent;
                EXPECT_GE(error.lower, std::ldexp(plain.lower, exponent) - unit) << exponent;
            }
        }
    }
}

// A hull of usual size around a speck, far larger than that: every point is that far from it.
TEST(HullError, OfAHullMuchLargerThanItsMeshIsItsSize) {
    const Mesh speck = mesh_of(test::moved_by(test::unit_cube(), 1e-300, {}));
    const ConvexHull hull = convex_hull(test::moved_by(test::unit_cube(), 2, {}).positions);
    const HullError error = find_hull_error(hull, speck, Reference::solid, serial_for);
    EXPECT_NEAR(error.lower, 2 * std::sqrt(3), 0.1);
    EXPECT_NEAR(error.upper, 2 * std::sqrt(3), 0.1);
}

// Random tetrahedra about a torus, against many points of each: none is farther from the
// solid than `upper`, and `worst` is as far as it is said to be.
TEST(HullErrorLaws, BoundsHoldOfEveryPointOfTheHull) {
    const Mesh mesh = mesh_of(test::torus(1, 0.4, 24, 12));
    const Solid solid(mesh, Reference::solid, serial_for);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1.2, 1.2);
    std::uniform_real_distribution<double> small(-0.08, 0.08);
    std::uniform_real_distribution<double> weight(0, 1);
    int inside = 0;
    constexpr int kRounds = 200;
    for (int round = 0; round < kRounds; ++round) {
        // Half of them small ones about the torus' own circle.
        const bool is_small = round % 2 == 0;
        const Double3 at = is_small ? Double3{1, 0, 0} : Double3{0, 0, 0};
        auto& draw = is_small ? small : place;
        std::array<Double3, 4> corners;
        for (Double3& p : corners) {
            const double x = draw(random);
            const double y = draw(random);
            p = {at.x + x, at.y + y, at.z + draw(random)};
        }
        const ConvexHull hull = convex_hull(corners);
        const HullError error = find_hull_error(hull, solid, {.enough = 1e-3});
        EXPECT_LE(error.lower, error.upper);
        if (error.upper <= 2e-3) ++inside;
        if (error.lower > 0) {
            EXPECT_NEAR(surface_distance(mesh, error.worst), error.lower, 1e-9) << round;
        }
        for (int i = 0; i < 50; ++i) {
            std::array<double, 4> share;
            double sum = 0;
            for (double& s : share) sum += s = -std::log(weight(random) + 1e-300);
            Double3 p = {0, 0, 0};
            for (std::size_t k = 0; k < 4; ++k) {
                const double s = share[k] / sum;
                p = {p.x + s * corners[k].x, p.y + s * corners[k].y, p.z + s * corners[k].z};
            }
            if (solid.includes(p)) continue;
            EXPECT_LE(surface_distance(mesh, p), error.upper + 1e-9) << round;
        }
    }
    EXPECT_GT(inside, kRounds * 3 / 10);
    EXPECT_LT(inside, kRounds * 7 / 10);
}

}  // namespace
}  // namespace cdprep::convex
