// SPDX-License-Identifier: MIT
// CGAL's exact kernel is the second opinion.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>

#include "hull/convex_hull.h"
#include "support/seed_mesh.h"

namespace cdprep::convex {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = std::vector<Double3>;
using PointSet = std::set<std::array<double, 3>>;

PointSet corners_by_cgal(const Points& points) {
    std::vector<Kernel::Point_3> converted;
    for (const Double3& p : points) converted.emplace_back(p.x, p.y, p.z);
    CGAL::Surface_mesh<Kernel::Point_3> hull;
    CGAL::convex_hull_3(converted.begin(), converted.end(), hull);
    PointSet corners;
    for (const auto vertex : hull.vertices()) {
        const Kernel::Point_3& p = hull.point(vertex);
        corners.insert({p.x(), p.y(), p.z()});
    }
    return corners;
}

PointSet corners(const ConvexHull& hull) {
    PointSet corners;
    for (const Double3& p : hull.points) corners.insert({p.x, p.y, p.z});
    return corners;
}

TEST(ConvexHullByCgal, FinePointsHaveTheSameCorners) {
    std::mt19937 random(11);
    std::normal_distribution<double> fine;
    for (const int count : {10, 100, 1'000, 20'000}) {
        for (const double flatness : {1.0, 1e-3, 1e-12}) {
            Points points;
            for (int i = 0; i < count; ++i) {
                points.push_back({fine(random), fine(random), flatness * fine(random)});
            }
            EXPECT_EQ(corners(convex_hull(points)), corners_by_cgal(points));
        }
    }
}

// Scans: floats, so that coplanar points do occur.
TEST(ConvexHullByCgal, LargeModelsHaveTheSameCorners) {
    std::size_t asked = 0;
    for (const char* name : {"skull", "bunny", "armadillo", "buddha", "horse", "dragon"}) {
        const auto mesh = test::seed_mesh_as_read(name);
        if (!mesh) continue;
        ++asked;
        EXPECT_EQ(corners(convex_hull(mesh->positions)), corners_by_cgal(mesh->positions)) << name;
    }
    if (asked == 0) GTEST_SKIP() << "no test models beside this checkout";
}

}  // namespace
}  // namespace cdprep::convex
