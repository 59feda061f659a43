// SPDX-License-Identifier: MIT
#include "mesh/weld.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

/// One triangle over each three of the points.
TriangleSoup soup_over(std::vector<Double3> points) {
    TriangleSoup soup;
    soup.positions = std::move(points);
    for (std::uint32_t i = 0; i + 2 < soup.positions.size(); i += 3) {
        soup.triangles.push_back({{i, i + 1, i + 2}});
    }
    return soup;
}

// A cube has 8 corners, however often its 12 triangles write them down.
TEST(Weld, EqualPositionsBecomeOneVertex) {
    const TriangleSoup soup = test::soup_of(test::unshared(test::unit_cube()));
    ASSERT_EQ(soup.positions.size(), 36U);
    const Welded welded = weld(soup);
    EXPECT_EQ(welded.mesh.positions.size(), 8U);
    EXPECT_EQ(welded.report.merged_vertices, 28U);
    EXPECT_EQ(welded.report.collapsed_triangles, 0U);
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            EXPECT_EQ(welded.mesh.positions[welded.mesh.triangles[i].vertex[corner]],
                      soup.positions[soup.triangles[i].vertex[corner]]);
        }
    }
}

TEST(Weld, NegativeZeroEqualsZero) {
    const Welded welded = weld(soup_over({{0, 1, 0}, {1, 0, 0}, {0, 0, -0.0}, {-0.0, 0, 0}}));
    EXPECT_EQ(welded.mesh.positions.size(), 3U);  // the fourth is unused
    TriangleSoup both = soup_over({{0, 1, 0}, {1, 0, 0}, {0, 0, -0.0}, {-0.0, 0, 0}});
    both.triangles.push_back({{0, 1, 3}});
    const Welded joined = weld(both);
    EXPECT_EQ(joined.mesh.positions.size(), 3U);
    EXPECT_EQ(joined.mesh.triangles[0], joined.mesh.triangles[1]);
}

// 1 and its neighbour differ in one bit.
TEST(Weld, PositionsThatDifferInTheLastBitStayApart) {
    TriangleSoup soup =
        soup_over({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {std::nextafter(1.0, 2.0), 0, 0}});
    soup.triangles.push_back({{1, 2, 3}});
    EXPECT_EQ(weld(soup).mesh.positions.size(), 4U);
}

TEST(Weld, SurvivorsKeepTheOrderAndPlaceOfTheLowestNumber) {
    TriangleSoup soup =
        soup_over({{5, 0, 0}, {4, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {9, 9, 9}});
    const Welded welded = weld(soup);
    EXPECT_EQ(welded.mesh.source_vertex, (std::vector<std::uint32_t>{0, 1, 2, 5}));
    EXPECT_EQ(welded.mesh.positions[3], (Double3{9, 9, 9}));
    EXPECT_EQ(welded.mesh.triangles[1], (Triangle{{1, 0, 3}}));
}

TEST(Weld, UnusedVerticesAreLeftOut) {
    TriangleSoup soup = soup_over({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 7, 7}, {8, 8, 8}});
    const Welded welded = weld(soup);
    EXPECT_EQ(welded.mesh.positions.size(), 3U);
    EXPECT_EQ(welded.report.unused_vertices, 2U);
    EXPECT_EQ(welded.report.merged_vertices, 0U);
}

TEST(Weld, CollapsedTrianglesAreKeptAndCounted) {
    const Welded welded = weld(soup_over({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}));
    EXPECT_EQ(welded.report.collapsed_triangles, 1U);
    ASSERT_EQ(welded.mesh.triangles.size(), 1U);
    EXPECT_EQ(welded.mesh.triangles[0], (Triangle{{0, 0, 1}}));
}

TEST(Weld, AnEmptySoupGivesAnEmptyMesh) {
    for (const double distance : {0.0, 1.0}) {
        const Welded welded = weld({}, {.distance = distance});
        EXPECT_TRUE(welded.mesh.positions.empty());
        EXPECT_TRUE(welded.mesh.triangles.empty());
    }
}

TEST(Weld, KeepsWhetherPositionsAreFloats) {
    TriangleSoup soup;
    EXPECT_FALSE(weld(soup).mesh.single_precision);
    soup.single_precision = true;
    EXPECT_TRUE(weld(soup).mesh.single_precision);
}

TEST(Weld, TheDistanceIsInclusive) {
    const TriangleSoup soup = soup_over({{0, 0, 0}, {0.5, 0, 0}, {9, 0, 0}});
    EXPECT_EQ(weld(soup, {.distance = 0.5}).mesh.positions.size(), 2U);
    EXPECT_EQ(weld(soup, {.distance = std::nextafter(0.5, 0.0)}).mesh.positions.size(), 3U);
}

// Each point is 1 from the next: all are one group though the ends are 5 apart.
TEST(Weld, ChainsJoin) {
    const TriangleSoup soup =
        soup_over({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {1, 0, 0}, {3, 0, 0}, {5, 0, 0}});
    const Welded welded = weld(soup, {.distance = 1});
    EXPECT_EQ(welded.mesh.positions.size(), 1U);
    EXPECT_EQ(welded.mesh.positions[0], (Double3{0, 0, 0}));
    EXPECT_EQ(welded.report.merged_vertices, 5U);
    EXPECT_EQ(welded.report.collapsed_triangles, 2U);
    EXPECT_EQ(weld(soup, {.distance = 0.999}).mesh.positions.size(), 6U);
}

// A huge distance and a tiny one: no cell number may leave the range of integers.
TEST(Weld, DistancesOfAnySizeWork) {
    const TriangleSoup soup = soup_over({{1e300, 0, 0}, {-1e300, 1e-300, 0}, {1, 2, 3}});
    EXPECT_EQ(weld(soup, {.distance = std::numeric_limits<double>::max()}).mesh.positions.size(),
              1U);
    EXPECT_EQ(
        weld(soup, {.distance = std::numeric_limits<double>::denorm_min()}).mesh.positions.size(),
        3U);
    EXPECT_EQ(weld(soup, {.distance = 4}).mesh.positions.size(), 3U);
}

// Neighbouring doubles near 1 are 2^-52 apart: finer than any grid of integers.
TEST(Weld, DistancesOfAFewUlpWork) {
    const double ulp = 0x1p-52;
    const TriangleSoup soup = soup_over({{1, 1, 1},
                                         {1 + ulp, 1, 1},
                                         {1 + 3 * ulp, 1, 1},
                                         {1, 1 + ulp, 1 + ulp},
                                         {2, 2, 2},
                                         {1 + 9 * ulp, 1, 1}});
    EXPECT_EQ(weld(soup, {.distance = ulp}).mesh.positions.size(), 5U);
    EXPECT_EQ(weld(soup, {.distance = 1.5 * ulp}).mesh.positions.size(), 4U);
    EXPECT_EQ(weld(soup, {.distance = 2 * ulp}).mesh.positions.size(), 3U);
    EXPECT_EQ(weld(soup, {.distance = 6 * ulp}).mesh.positions.size(), 2U);
}

}  // namespace
}  // namespace cdprep::mesh
