// SPDX-License-Identifier: MIT
#include "cdprep/pairs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cdprep/advanced/query_counts.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/placements.h"
#include "support/touched.h"

namespace cdprep::test {
namespace {

std::size_t count(const TestMesh& a, const TestMesh& b, const Placement& placement,
                  double tolerance, const PairOptions& options = {}) {
    const OpenModel model_a = open_tiny(a, {.double_precision = true});
    const OpenModel model_b = open_tiny(b, {.double_precision = true});
    Workspace workspace;
    return pairs_within({model_a.model, model_b.model, placement, options}, tolerance, workspace,
                        {});
}

// By hand: cubes a gap apart along x. The two triangles of either face that looks at the
// other are the gap apart, for the faces lie half over each other; others have an edge
// or a corner there.
TEST(TrianglesWithin, TheTolerancesOwnDistanceCounts) {
    for (const double gap : {1.0, 0.5, 0x1p-10, 0x1p-30, 3 * 0x1p-20}) {
        const Placement placement = shifted({1 + gap, 0.25, 0.125});
        EXPECT_GT(count(unit_cube(), unit_cube(), placement, gap), 4U) << gap;
        EXPECT_EQ(count(unit_cube(), unit_cube(), placement, std::nextafter(gap, 0.0)), 0U) << gap;
    }
}

// By hand: 3-4-5. Corner (0, 0) to corner (3, 4), and edges that run away from there.
TEST(TrianglesWithin, CornersAreTheirDistanceApart) {
    const TestMesh a{{{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}, {{{0, 1, 2}}}};
    const TestMesh b{{{3, 4, 0}, {4, 4, 0}, {3, 5, 0}}, {{{0, 1, 2}}}};
    EXPECT_EQ(count(a, b, shifted({0, 0, 0}), 5), 1U);
    EXPECT_EQ(count(a, b, shifted({0, 0, 0}), std::nextafter(5.0, 0.0)), 0U);
    EXPECT_EQ(count(a, b, shifted({0, 0, 0x1p-40}), 5), 0U);
}

// By hand: sheets over one another, a quarter of a square apart, so that a triangle is
// 1 from those above it alone.
TEST(TrianglesWithin, SheetsOverOneAnotherMeetWhatIsAbove) {
    const TestMesh sheet = grid_sheet(20, 20);
    const Placement above = shifted({0, 0, 1});
    EXPECT_EQ(count(sheet, sheet, above, 1), count(sheet, sheet, shifted({0, 0, 0}), 0));
    EXPECT_EQ(count(sheet, sheet, above, std::nextafter(1.0, 0.0)), 0U);
    EXPECT_GT(count(sheet, sheet, above, std::sqrt(2)), count(sheet, sheet, above, 1.4));
}

// By the definition of the order and of a span that is too short.
TEST(TrianglesWithin, ShortSpanHoldsTheSmallestPairs) {
    const OpenModel sheet = open_tiny(grid_sheet(12, 12));
    Workspace workspace;
    const auto ask = [&](std::span<TrianglePair> room) {
        return pairs_within({sheet.model, sheet.model, shifted({0.25, 0, 0.5})}, 0.75, workspace,
                            room);
    };
    std::vector<TrianglePair> all(ask({}));
    EXPECT_EQ(ask(all), all.size());
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    std::vector<TrianglePair> some(17);
    EXPECT_EQ(ask(some), all.size());
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
}

// By the definition: no tolerance below 0 holds anything, an infinite one all.
TEST(TrianglesWithin, OddTolerancesHaveDefinedAnswers) {
    const Placement far = shifted({1e300, 0, 0});
    for (const Placement& placement : {shifted({0, 0, 0}), shifted({5, 0, 0}), far}) {
        EXPECT_EQ(count(unit_cube(), unit_cube(), placement, -1), 0U);
        EXPECT_EQ(count(unit_cube(), unit_cube(), placement, -kInfinity), 0U);
        EXPECT_EQ(count(unit_cube(), unit_cube(), placement, std::nan("")), 0U);
        EXPECT_EQ(count(unit_cube(), unit_cube(), placement, kInfinity), 144U);
        EXPECT_EQ(count(unit_cube(), unit_cube(), placement, 1.1e300), 144U);
        EXPECT_EQ(count({}, unit_cube(), placement, kInfinity), 0U);
        EXPECT_EQ(count(unit_cube(), {}, placement, 1), 0U);
        EXPECT_EQ(count({}, {}, placement, kInfinity), 0U);
    }
    EXPECT_EQ(count(unit_cube(), unit_cube(), far, 0.9e300), 0U);
}

// By hand: a triangle that is a point 3 above a face, and a segment 4 above it.
TEST(TrianglesWithin, DegenerateTrianglesAreWhatTheyAre) {
    const TestMesh floor{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {{{0, 1, 2}}}};
    const TestMesh thin{{{0, 0, 3}, {-1, 0, 4}, {0, 0, 4}, {1, 0, 4}}, {{{0, 0, 0}}, {{1, 2, 3}}}};
    const Placement still = shifted({0, 0, 0});
    EXPECT_EQ(count(floor, thin, still, std::nextafter(3.0, 0.0)), 0U);
    EXPECT_EQ(count(floor, thin, still, 3), 1U);
    EXPECT_EQ(count(floor, thin, still, 4), 2U);
    for (const double tolerance : {3.0, 4.0, kInfinity}) {
        EXPECT_EQ(count(floor, thin, still, tolerance, {.degenerate = Degenerate::skip}), 0U)
            << tolerance;
    }
}

// By construction: a torus of every size within a tolerance that grows with it; and one
// that is far away from the other, against how large it is.
TEST(TrianglesWithin, SizeDoesNotMatter) {
    const TestMesh ring = torus(2, 0.5, 16, 8);
    const std::size_t expected = count(ring, ring, shifted({0.5, 0, 0.25}), 0.125);
    EXPECT_GT(expected, ring.triangles.size());
    for (const int exponent : {-1000, -200, -40, 40, 200, 900}) {
        const auto at = [&](double x) { return std::ldexp(x, exponent); };
        const TestMesh sized = moved_by(ring, at(1), {0, 0, 0});
        EXPECT_EQ(count(sized, sized, shifted({at(0.5), 0, at(0.25)}), at(0.125)), expected)
            << exponent;
    }
    for (const double far : {0x1p20, 0x1p45, 0x1p70, 0x1p500}) {
        const std::size_t all = ring.triangles.size() * ring.triangles.size();
        EXPECT_EQ(count(ring, ring, shifted({far, 0, 0}), far * 1.5), all) << far;
        EXPECT_EQ(count(ring, ring, shifted({far, 0, 0}), far * 0.5), 0U) << far;
    }
    const TestMesh dot{{{0, 0, 0}}, {{{0, 0, 0}}}};
    for (const double far : {0x1p20, 0x1p45, 0x1p70, 0x1p500}) {
        EXPECT_EQ(count(dot, dot, shifted({far, 0, 0}), far), 1U) << far;
        EXPECT_EQ(count(dot, dot, shifted({far, 0, 0}), std::nextafter(far, 0.0)), 0U) << far;
    }
}

// By counters, which no machine changes: a tolerance that is small against the models
// leads to few of their triangles.
TEST(TrianglesWithin, SmallTolerancesLookAtLittle) {
    const OpenModel ball = open_tiny(icosphere(5));
    Workspace workspace;
    QueryCounts counts;
    workspace.count_into(&counts);
    const std::size_t found =
        pairs_within({ball.model, ball.model, shifted({2.01, 0, 0})}, 0.02, workspace, {});
    EXPECT_GT(found, 100U);
    EXPECT_LT(counts.triangle_pairs, 20'000'000U);
    EXPECT_LT(counts.triangle_pairs, 100 * found);
}

}  // namespace
}  // namespace cdprep::test
