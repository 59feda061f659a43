// SPDX-License-Identifier: MIT
// Hard point sets whose hulls are known, and laws that every hull obeys.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hull/convex_hull.h"
#include "support/hard_point_sets.h"
#include "support/meshes.h"
#include "unit/tools/hull_flaw.h"

namespace cdprep::convex {
namespace {

using test::hull_flaw;
using Points = std::vector<Double3>;
using Facet = std::array<std::uint32_t, 3>;

std::size_t face_count(const ConvexHull& hull) {
    return hull.groups.size() - 1;
}

// C01: points that are collinear or coplanar but for the last bit span more, exactly.
TEST(ConvexHullLaws, AlmostFlatPointsAreWhatTheirBitsSay) {
    const double next = std::nextafter(1.0, 2.0);
    const Points line = {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {1, 1, next}};
    EXPECT_EQ(convex_hull(line).dimension, 2);
    EXPECT_EQ(hull_flaw(line, convex_hull(line)), "");
    const Points plane = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, 0.5, next}};
    EXPECT_EQ(convex_hull(plane).dimension, 3);
    EXPECT_EQ(hull_flaw(plane, convex_hull(plane)), "");
}

// C02, by hand: a lattice is a cube.
TEST(ConvexHullLaws, LatticeHasEightCornersAndSixFaces) {
    const Points points = test::lattice(100);
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.numbers, (std::vector<std::uint32_t>{0, 99, 9'900, 9'999, 990'000, 990'099,
                                                        999'900, 999'999}));
    EXPECT_EQ(face_count(hull), 6U);
    EXPECT_EQ(hull_flaw(points, hull), "");
}

// C03, by hand: nor do points on a cube's faces and edges add corners.
TEST(ConvexHullLaws, PointsOnFacesAreNoCorners) {
    const Points points = test::crowded_faces(100'000);
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.points.size(), 8U);
    EXPECT_EQ(face_count(hull), 6U);
    EXPECT_EQ(hull_flaw(points, hull), "");
}

// C04: all points of a sphere are extreme, whatever planes they share.
TEST(ConvexHullLaws, CosphericalPointsAreAllExtreme) {
    Points points = test::shuffled(test::lattice_sphere(1155), 1);
    ASSERT_EQ(points.size(), 17'550U);
    points.resize(10'000);
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.points.size(), points.size());
    EXPECT_EQ(hull_flaw(points, hull), "");
    const Points symmetric = test::lattice_sphere(15);  // many coplanar faces
    const ConvexHull faces = convex_hull(symmetric);
    EXPECT_EQ(faces.points.size(), symmetric.size());
    EXPECT_LT(face_count(faces), faces.facets.size());
    EXPECT_EQ(hull_flaw(symmetric, faces), "");
}

// C05: n vertices, 2n - 4 facets, known one by one.
TEST(ConvexHullLaws, MomentCurveIsACyclicPolytope) {
    for (const int count : {5, 100, 1 << 12, 1 << 16}) {
        const Points points = test::moment_curve(count);
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(hull.points.size(), points.size());
        EXPECT_EQ(face_count(hull), 2 * points.size() - 4);
        EXPECT_EQ(hull.facets, test::cyclic_facets(static_cast<std::uint32_t>(count)));
        if (count > 100) continue;
        EXPECT_EQ(hull_flaw(points, hull), "");
    }
}

// C06, by hand: one bit above a face's centre is a corner; on it or below it is none.
TEST(ConvexHullLaws, BumpsOnACubeAreCorners) {
    for (const double bump : {0x1p-52, 0.0, -0x1p-52, 0.25}) {
        const Points points = test::cube_with_bumps(bump);
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(hull.points.size(), bump > 0 ? 14U : 8U);
        EXPECT_EQ(face_count(hull), bump > 0 ? 24U : 6U);
        EXPECT_EQ(hull_flaw(points, hull), "");
    }
}

// C07: a plane but for the last bit, at three heights.
TEST(ConvexHullLaws, NoisyPlaneHoldsAllPoints) {
    for (const double height : {1.0, 0.0, 1e300}) {
        const Points points = test::noisy_plane(10'000, height);
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(hull.dimension, 3);
        EXPECT_EQ(hull_flaw(points, hull), "");
    }
}

using Triangles = std::vector<std::array<std::array<double, 3>, 3>>;

/// The facets as triples of points, sorted: what does not depend on numbers.
Triangles triangles_of(const ConvexHull& hull) {
    Triangles triangles;
    for (const Facet& facet : hull.facets) {
        std::array<std::array<double, 3>, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const Double3& p = hull.points[facet[i]];
            corners[i] = {p.x, p.y, p.z};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        triangles.push_back(corners);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// Per face, its corners' numbers, sorted: what does not depend on diagonals.
std::vector<std::vector<std::uint32_t>> faces_of(const ConvexHull& hull) {
    std::vector<std::vector<std::uint32_t>> faces;
    for (std::size_t g = 0; g < face_count(hull); ++g) {
        std::vector<std::uint32_t> corners;
        for (std::uint32_t f = hull.groups[g]; f < hull.groups[g + 1]; ++f) {
            for (const std::uint32_t p : hull.facets[f]) corners.push_back(hull.numbers[p]);
        }
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        faces.push_back(corners);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

// C08
TEST(ConvexHullLaws, OrderOfPointsChangesNothingButNumbers) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const Points points = test::mixed_points(seed);
        const Points other = test::shuffled(points, seed);
        EXPECT_EQ(triangles_of(convex_hull(points)), triangles_of(convex_hull(other)));
    }
}

// C08
TEST(ConvexHullLaws, RepeatedPointsChangeNothing) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const Points points = test::mixed_points(seed);
        Points twice = points;
        twice.insert(twice.end(), points.rbegin(), points.rend());
        const ConvexHull once = convex_hull(points), again = convex_hull(twice);
        EXPECT_EQ(once.numbers, again.numbers);
        EXPECT_EQ(once.facets, again.facets);
        EXPECT_EQ(once.groups, again.groups);
    }
}

// C08, up to where squares, then differences of coordinates, leave the range of doubles.
TEST(ConvexHullLaws, ScalingByPowersOfTwoChangesNothing) {
    for (const int exponent : {-1000, -400, -3, 50, 400, 1000}) {
        for (std::uint32_t seed = 0; seed < 20; ++seed) {
            const Points points = test::mixed_points(seed);
            Points scaled = points;
            for (Double3& p : scaled) {
                p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent),
                     std::ldexp(p.z, exponent)};
            }
            const ConvexHull hull = convex_hull(points), large = convex_hull(scaled);
            EXPECT_EQ(hull.numbers, large.numbers);
            EXPECT_EQ(hull.facets, large.facets) << exponent;
            EXPECT_EQ(hull.groups, large.groups);
        }
    }
}

// C08: the faces stay; their diagonals follow the order of the axes.
TEST(ConvexHullLaws, SwappedAxesChangeNoFace) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const Points points = test::mixed_points(seed);
        Points swapped = points, turned = points;
        for (Double3& p : swapped) p = {p.y, p.x, p.z};
        for (Double3& p : turned) p = {-p.z, p.x, p.y};
        EXPECT_EQ(faces_of(convex_hull(points)), faces_of(convex_hull(swapped)));
        EXPECT_EQ(faces_of(convex_hull(points)), faces_of(convex_hull(turned)));
        EXPECT_EQ(hull_flaw(swapped, convex_hull(swapped)), "");
    }
}

TEST(ConvexHullLaws, HullOfAHullIsIt) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const ConvexHull hull = convex_hull(test::mixed_points(seed));
        const ConvexHull again = convex_hull(hull.points);
        EXPECT_EQ(again.points.size(), hull.points.size());
        EXPECT_EQ(again.facets, hull.facets);
        EXPECT_EQ(again.groups, hull.groups);
    }
}

// C09: a million points of a ball, all inside by exact numbers.
TEST(ConvexHullLaws, MillionPointsAreInside) {
    const Points points = test::points_in_a_ball(1'000'000);
    const ConvexHull hull = convex_hull(points);
    EXPECT_GT(hull.points.size(), 1000U);
    EXPECT_EQ(hull_flaw(points, hull), "");
}

}  // namespace
}  // namespace cdprep::convex
