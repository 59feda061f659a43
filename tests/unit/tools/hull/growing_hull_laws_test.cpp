// SPDX-License-Identifier: MIT
#include "hull/growing_hull.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "unit/tools/pieces_flaw.h"

namespace cdprep::convex {
namespace {

/// GridPoints of a coarse grid, where much is coplanar and touches, or of a fine one.
class GridPoints {
public:
    GridPoints(std::uint32_t seed, int grid) : random_(seed), grid_(grid) {}
    Double3 one() {
        std::uniform_int_distribution<int> at(-grid_, grid_);
        const double scale = grid_ > 100 ? 1.0 / 3 : 1;
        return {scale * at(random_), scale * at(random_), scale * at(random_)};
    }
    std::vector<Double3> distinct(std::size_t count) {
        std::vector<Double3> points;
        while (points.size() < count) {
            const Double3 p = one();
            if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
        }
        return points;
    }
    std::mt19937& random() {
        return random_;
    }

private:
    std::mt19937 random_;
    int grid_;
};

using Facets = std::vector<std::array<Double3, 3>>;

/// The boundary has every point on or behind it, each edge once in either direction.
void expect_hull_of(const GrowingHull& hull, const std::vector<Double3>& points) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::size_t facets = 0;
    for (std::uint32_t f = 0; f < hull.facets().size(); ++f) {
        const auto& [corner, across] = hull.facets()[f];
        if (corner[0] == GrowingHull::kDead) continue;
        ++facets;
        const auto& at = hull.points();
        const test::ExactPlane plane =
            test::exact_plane(at[corner[0]], at[corner[1]], at[corner[2]]);
        EXPECT_FALSE(plane.degenerate());
        for (const Double3& p : points) EXPECT_LE(plane.side(p), 0);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_TRUE(edges.insert({corner[k], corner[(k + 1) % 3]}).second);
            const auto& back = hull.facets()[across[k]].across;
            EXPECT_NE(std::find(back.begin(), back.end(), f), back.end());
        }
    }
    for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from}));
    EXPECT_EQ(edges.size(), 3 * facets);
}

TEST(GrowingHull, IsTheHullOfItsPoints) {
    for (const int grid : {2, 4, 1000}) {
        GridPoints points(grid, grid);
        for (int round = 0; round < 60; ++round) {
            const std::vector<Double3> all = points.distinct(4 + round % 20);
            GrowingHull hull;
            const bool is_solid = hull.build(all);
            EXPECT_EQ(is_solid, convex_hull(all).dimension == 3);
            if (is_solid) expect_hull_of(hull, all);
        }
    }
}

// A hull that has been another before forgets all of it.
TEST(GrowingHull, AdoptsAHullAndGrowsOn) {
    GridPoints points(31, 1000);
    GrowingHull hull;
    for (int round = 0; round < 60; ++round) {
        const std::vector<Double3> others = points.distinct(20);
        ASSERT_TRUE(hull.build(others));
        const ConvexHull known = convex_hull(points.distinct(6));
        if (known.dimension != 3) continue;
        hull.adopt(known.points, known.facets);
        std::vector<Double3> all = known.points;
        expect_hull_of(hull, all);
        for (int i = 0; i < 4; ++i) {
            all.push_back(points.one());
            hull.add(all.back());
            expect_hull_of(hull, all);
        }
    }
}

// The oracle clips the triangle with every facet's plane in exact rationals.
TEST(GrowingHull, SaysWhetherATriangleHasAPointInside) {
    for (const int grid : {2, 3, 1000}) {
        GridPoints points(7 + grid, grid);
        int inside = 0, asked = 0;
        for (int round = 0; round < 40; ++round) {
            const std::vector<Double3> all = points.distinct(4 + round % 5);
            GrowingHull hull;
            if (!hull.build(all)) continue;
            const test::ExactBody body(convex_hull(all));
            for (int i = 0; i < 4; ++i) {
                Corners triangle = {points.one(), points.one(), points.one()};
                // Corners of the hull make contact likely.
                if (i % 2 == 1) triangle[0] = all[points.random()() % all.size()];
                const bool expected = body.is_entered_by(triangle);
                EXPECT_EQ(hull.has_inside(triangle), expected);
                inside += expected ? 1 : 0;
                ++asked;
            }
        }
        EXPECT_GT(inside, 0.3 * asked) << grid;
        EXPECT_LT(inside, 0.7 * asked) << grid;
    }
}

// By hand: the square through four edges of an octahedron meets every facet in edges only.
TEST(GrowingHull, ASectionThroughEdgesIsInside) {
    GrowingHull hull;
    ASSERT_TRUE(hull.build(
        std::vector<Double3>{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}));
    EXPECT_TRUE(hull.has_inside({{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}}));
    EXPECT_TRUE(hull.has_inside({{{9, -9, 0}, {0, 9, 0}, {-9, -9, 0}}}));
    EXPECT_FALSE(hull.has_inside({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}));
    EXPECT_FALSE(hull.has_inside({{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}));
    EXPECT_TRUE(hull.has_inside({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}));
}

}  // namespace
}  // namespace cdprep::convex
