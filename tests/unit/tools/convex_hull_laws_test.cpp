// SPDX-License-Identifier: MIT
// Hard point sets whose hulls are known, and laws that every hull obeys.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

#include "convex/convex_hull.h"
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

Points cube_corners(double size) {
    Points corners = test::unit_cube().positions;
    for (Double3& p : corners) p = {p.x * size, p.y * size, p.z * size};
    return corners;
}

Points shuffled(Points points, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::shuffle(points.begin(), points.end(), random);
    return points;
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
    Points points;
    for (int i = 0; i < 1'000'000; ++i) {
        points.push_back({double(i % 100), double(i / 100 % 100), double(i / 10'000)});
    }
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.numbers, (std::vector<std::uint32_t>{0, 99, 9'900, 9'999, 990'000, 990'099,
                                                        999'900, 999'999}));
    EXPECT_EQ(face_count(hull), 6U);
    EXPECT_EQ(hull_flaw(points, hull), "");
}

// C03, by hand: nor do points on a cube's faces and edges add corners.
TEST(ConvexHullLaws, PointsOnFacesAreNoCorners) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> inside(0, 1 << 20);
    Points points = cube_corners(1 << 20);
    for (int i = 0; i < 100'000; ++i) {
        std::array<double, 3> p = {double(inside(random)), double(inside(random)),
                                   double(inside(random))};
        p[static_cast<std::size_t>(i % 3)] = i % 2 == 0 ? 0 : 1 << 20;
        if (i % 7 == 0) p[static_cast<std::size_t>((i + 1) % 3)] = 0;
        points.push_back({p[0], p[1], p[2]});
    }
    points = shuffled(points, 4);
    const ConvexHull hull = convex_hull(points);
    EXPECT_EQ(hull.points.size(), 8U);
    EXPECT_EQ(face_count(hull), 6U);
    EXPECT_EQ(hull_flaw(points, hull), "");
}

// C04: all points of a sphere are extreme, whatever planes they share.
TEST(ConvexHullLaws, CosphericalPointsAreAllExtreme) {
    Points points = shuffled(test::lattice_sphere(1155), 1);
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

Points moment_curve(int count) {
    Points points;
    for (int t = 1; t <= count; ++t) {
        const double x = t;
        points.push_back({x, x * x, x * x * x});
    }
    return points;
}

/// Gale: neighbours with the first or with the last point are the facets of a cyclic
/// polytope; seen from later points, earlier ones turn counter-clockwise.
std::vector<Facet> cyclic_facets(std::uint32_t count) {
    std::vector<Facet> facets;
    for (std::uint32_t i = 1; i + 1 < count; ++i) facets.push_back({0, i + 1, i});
    for (std::uint32_t i = 0; i + 2 < count; ++i) facets.push_back({i, i + 1, count - 1});
    std::sort(facets.begin(), facets.end());
    return facets;
}

// C05: n vertices, 2n - 4 facets, known one by one.
TEST(ConvexHullLaws, MomentCurveIsACyclicPolytope) {
    for (const int count : {5, 100, 1 << 12, 1 << 16}) {
        const Points points = moment_curve(count);
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(hull.points.size(), points.size());
        EXPECT_EQ(face_count(hull), 2 * points.size() - 4);
        EXPECT_EQ(hull.facets, cyclic_facets(static_cast<std::uint32_t>(count)));
        if (count > 100) continue;
        EXPECT_EQ(hull_flaw(points, hull), "");
    }
}

// C06, by hand: one bit above a face's centre is a corner; on it or below it is none.
TEST(ConvexHullLaws, BumpsOnACubeAreCorners) {
    for (const double bump : {0x1p-52, 0.0, -0x1p-52, 0.25}) {
        Points points = cube_corners(1);
        for (int axis = 0; axis < 6; ++axis) {
            std::array<double, 3> p = {0.5, 0.5, 0.5};
            p[static_cast<std::size_t>(axis % 3)] = axis < 3 ? 1 + bump : -bump;
            points.push_back({p[0], p[1], p[2]});
        }
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(hull.points.size(), bump > 0 ? 14U : 8U);
        EXPECT_EQ(face_count(hull), bump > 0 ? 24U : 6U);
        EXPECT_EQ(hull_flaw(points, hull), "");
    }
}

// C07: a plane but for the last bit, at three heights.
TEST(ConvexHullLaws, NoisyPlaneHoldsAllPoints) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> flat(-1, 1);
    std::uniform_int_distribution<int> noise(-1, 1);
    for (const double height : {1.0, 0.0, 1e300}) {
        Points points;
        for (int i = 0; i < 10'000; ++i) {
            const int step = noise(random);
            const double z = step == 0 ? height : std::nextafter(height, step * 1e308);
            points.push_back({flat(random), flat(random), z});
        }
        const ConvexHull hull = convex_hull(points);
        EXPECT_EQ(hull.dimension, 3);
        EXPECT_EQ(hull_flaw(points, hull), "");
    }
}

Points mixed_points(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> fine(-1, 1);
    std::uniform_int_distribution<int> grid(-2, 2);
    Points points;
    for (int i = 0; i < 60; ++i) {
        if (seed % 2 == 0) {
            points.push_back({fine(random), fine(random), fine(random)});
        } else {
            points.push_back({double(grid(random)), double(grid(random)), double(grid(random))});
        }
    }
    return points;
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
        const Points points = mixed_points(seed);
        const Points other = shuffled(points, seed);
        EXPECT_EQ(triangles_of(convex_hull(points)), triangles_of(convex_hull(other)));
    }
}

// C08
TEST(ConvexHullLaws, RepeatedPointsChangeNothing) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const Points points = mixed_points(seed);
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
            const Points points = mixed_points(seed);
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
        const Points points = mixed_points(seed);
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
        const ConvexHull hull = convex_hull(mixed_points(seed));
        const ConvexHull again = convex_hull(hull.points);
        EXPECT_EQ(again.points.size(), hull.points.size());
        EXPECT_EQ(again.facets, hull.facets);
        EXPECT_EQ(again.groups, hull.groups);
    }
}

// C09: a million points of a ball, all inside by exact numbers.
TEST(ConvexHullLaws, MillionPointsAreInside) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> inside(-1, 1);
    Points points;
    while (points.size() < 1'000'000) {
        const Double3 p = {inside(random), inside(random), inside(random)};
        if (p.x * p.x + p.y * p.y + p.z * p.z <= 1) points.push_back(p);
    }
    const ConvexHull hull = convex_hull(points);
    EXPECT_GT(hull.points.size(), 1000U);
    EXPECT_EQ(hull_flaw(points, hull), "");
}

}  // namespace
}  // namespace cdprep::convex
