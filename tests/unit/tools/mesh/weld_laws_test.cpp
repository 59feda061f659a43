// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/weld.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

constexpr std::uint32_t kSeed = 20261121;

/// The lowest vertex of each vertex's group, by comparing all pairs until nothing
/// changes any more.
std::vector<std::uint32_t> groups_by_brute_force(const std::vector<Double3>& points,
                                                 double distance) {
    std::vector<std::uint32_t> lowest(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) lowest[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < points.size(); ++j) {
                const double apart =
                    std::hypot(points[i].x - points[j].x, points[i].y - points[j].y,
                               points[i].z - points[j].z);
                if (apart <= distance && lowest[j] < lowest[i]) {
                    lowest[i] = lowest[j];
                    changed = true;
                }
            }
        }
    }
    return lowest;
}

/// Welds and compares every corner with the oracle. Returns the merged share.
double expect_as_brute_force(const TriangleSoup& soup, double distance) {
    const Welded welded = weld(soup, {.distance = distance});
    const std::vector<std::uint32_t> lowest = groups_by_brute_force(soup.positions, distance);
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = welded.mesh.triangles[i].vertex[corner];
            EXPECT_EQ(welded.mesh.source_vertex[vertex], lowest[soup.triangles[i].vertex[corner]])
                << "triangle " << i << ", distance " << distance << ", seed " << kSeed;
        }
    }
    EXPECT_TRUE(std::is_sorted(welded.mesh.source_vertex.begin(), welded.mesh.source_vertex.end()));
    EXPECT_EQ(welded.report.merged_vertices + welded.mesh.positions.size(), soup.positions.size());
    return static_cast<double>(welded.report.merged_vertices) /
           static_cast<double>(soup.positions.size());
}

void expect_same(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
}

TriangleSoup as_soup(const Mesh& mesh) {
    TriangleSoup soup;
    soup.positions = mesh.positions;
    soup.triangles = mesh.triangles;
    return soup;
}

TEST(WeldLaws, GroupsAreThoseOfBruteForce) {
    int rounds = 0, mixed = 0;
    for (const double distance : {0.0, 0.01, 0.1, 0.25, 0.5, 1.0, 1.5, 3.0}) {
        for (std::uint32_t seed = kSeed; seed < kSeed + 4; ++seed) {
            const double fine =
                expect_as_brute_force(test::soup_of(test::random_soup(seed, 60, 0.3)), distance);
            const double coarse =
                expect_as_brute_force(test::soup_of(test::coarse_grid_soup(seed, 60, 4)), distance);
            rounds += 2;
            mixed += (fine > 0.05 && fine < 0.95) + (coarse > 0.05 && coarse < 0.95);
        }
    }
    EXPECT_GT(mixed * 10, rounds * 3) << "too few soups merged in part";
}

// Powers of two scale without rounding, so groups stay the same.
TEST(WeldLaws, ScalingByAPowerOfTwoChangesNoGroup) {
    const test::TestMesh mesh = test::random_soup(kSeed, 80, 0.2);
    const Welded plain = weld(test::soup_of(mesh), {.distance = 0.125});
    ASSERT_GT(plain.report.merged_vertices, 10U);
    for (const int exponent : {-900, -40, 40, 900}) {
        const double scale = std::ldexp(1.0, exponent);
        const Welded scaled = weld(test::soup_of(test::moved_by(mesh, scale, {0, 0, 0})),
                                   {.distance = 0.125 * scale});
        EXPECT_EQ(scaled.mesh.triangles, plain.mesh.triangles) << exponent;
    }
}

// Far from the origin a distance is a few ulp: no rounding may lose a pair.
TEST(WeldLaws, GroupsFarFromTheOriginAreThoseOfBruteForce) {
    for (const int exponent : {20, 44, 46, 48, 50}) {
        const double far = std::ldexp(1.0, exponent);
        const test::TestMesh mesh =
            test::moved_by(test::coarse_grid_soup(kSeed, 60, 3), 1, {far, -far, far});
        const double merged = expect_as_brute_force(test::soup_of(mesh), 1);
        EXPECT_GT(merged, 0.3) << exponent;
        expect_as_brute_force(test::soup_of(mesh), 1.4142135623730951);
    }
}

TEST(WeldLaws, DoingItTwiceChangesNothing) {
    for (const double distance : {0.0, 0.05, 0.3}) {
        const Welded once =
            weld(test::soup_of(test::random_soup(kSeed, 200, 0.2)), {.distance = distance});
        const Welded twice = weld(as_soup(once.mesh), {.distance = distance});
        expect_same(once.mesh, twice.mesh);
        EXPECT_EQ(twice.report.merged_vertices, 0U);
        EXPECT_EQ(twice.report.unused_vertices, 0U);
    }
}

TEST(WeldLaws, UndoesTheTearingApartOfASharedMesh) {
    const test::TestMesh sphere = test::icosphere(3);
    const Welded welded = weld(test::soup_of(test::unshared(sphere)));
    EXPECT_EQ(welded.mesh.positions.size(), sphere.positions.size());
    EXPECT_EQ(welded.mesh.triangles.size(), sphere.triangles.size());
}

// 100,000 points within one distance: one pair of cells must not cost all pairs.
TEST(WeldLaws, ManyPointsWithinOneDistanceStayCheap) {
    test::TestMesh crowd = test::random_soup(kSeed, 100'000, 0.01);
    const Welded welded = weld(test::soup_of(crowd), {.distance = 10});
    EXPECT_EQ(welded.mesh.positions.size(), 1U);
}

}  // namespace
}  // namespace cdprep::mesh
