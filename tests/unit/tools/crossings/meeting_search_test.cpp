// SPDX-License-Identifier: MIT
// Limits end a search at the same place for any number of threads, and say so.
#include "crossings/meeting_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <tuple>

#include "support/large_stars.h"
#include "support/team.h"
#include "unit/tools/soup_of.h"
#include "validate/defects/find_defects.h"

namespace cdprep::mesh {
namespace {

constexpr std::uint32_t kSearchSeed = 20261122;

struct Outcome {
    std::vector<TriangleMeeting> found;  ///< sorted
    bool is_complete = false;
};

Outcome search(const Mesh& mesh, const SearchLimits& limits, ParallelFor parallel_for) {
    Outcome outcome;
    outcome.is_complete = search_self_intersections(
        mesh, {limits, {}, parallel_for}, [&](std::span<const TriangleMeeting> some) {
            outcome.found.insert(outcome.found.end(), some.begin(), some.end());
        });
    std::sort(outcome.found.begin(), outcome.found.end(),
              [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    return outcome;
}

/// One mesh for each way of searching: a walk, a large star, and both with a hub between.
std::vector<Mesh> meshes() {
    const test::TestMesh flat = test::coplanar_soup(kSearchSeed, 1000);
    const test::TestMesh star = test::random_star(kSearchSeed, 511);
    const test::TestMesh hub =
        test::joined(test::random_star(kSearchSeed, 600), test::random_soup(kSearchSeed, 500, 0.5));
    return {test::mesh_of(flat), test::mesh_of(star), test::mesh_of(hub)};
}

void expect_some_of(const Outcome& some, const Outcome& all) {
    EXPECT_TRUE(std::includes(
        all.found.begin(), all.found.end(), some.found.begin(), some.found.end(),
        [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); }));
}

TEST(MeetingSearch, AtALimitOfPairsItStopsAndSaysSo) {
    for (const Mesh& mesh : meshes()) {
        const Outcome all = search(mesh, {}, serial_for);
        ASSERT_TRUE(all.is_complete);
        ASSERT_GT(all.found.size(), 10000U);
        for (const std::uint64_t pairs :
             {std::uint64_t{1}, std::uint64_t{100}, std::uint64_t{5000}, all.found.size() - 1}) {
            const Outcome some = search(mesh, {.pairs = pairs}, serial_for);
            expect_some_of(some, all);
            EXPECT_GE(some.found.size(), pairs);
            // A step may go beyond by the pairs of triangles in 64 pairs of leaves.
            EXPECT_LT(some.found.size(), pairs + 4096);
            if (pairs == all.found.size() - 1) continue;
            EXPECT_FALSE(some.is_complete);
            EXPECT_LT(some.found.size(), all.found.size());
        }
        const Outcome enough = search(mesh, {.pairs = all.found.size() + 1}, serial_for);
        EXPECT_TRUE(enough.is_complete);
        EXPECT_EQ(enough.found, all.found);
    }
}

TEST(MeetingSearch, AtALimitOfStepsItStopsAndSaysSo) {
    for (const Mesh& mesh : meshes()) {
        const Outcome all = search(mesh, {}, serial_for);
        std::size_t before = 0;
        for (const std::uint64_t steps : {1, 1000, 10000, 1000000000}) {
            const Outcome some = search(mesh, {.steps = steps}, serial_for);
            expect_some_of(some, all);
            EXPECT_GE(some.found.size(), before);
            EXPECT_EQ(some.is_complete, steps == 1000000000) << steps;
            before = some.found.size();
        }
        EXPECT_EQ(before, all.found.size());
    }
}

TEST(MeetingSearch, AnyNumberOfThreadsStopsAtTheSamePairs) {
    for (const Mesh& mesh : meshes()) {
        for (const SearchLimits& limits : {SearchLimits{.pairs = 777}, SearchLimits{.pairs = 10000},
                                           SearchLimits{.steps = 20000}, SearchLimits{}}) {
            const Outcome alone = search(mesh, limits, serial_for);
            EXPECT_FALSE(alone.found.empty());
            for (const unsigned threads : {2U, 3U, 8U}) {
                const test::Team team(threads);
                const Outcome together = search(mesh, limits, team);
                EXPECT_EQ(together.found, alone.found) << threads;
                EXPECT_EQ(together.is_complete, alone.is_complete);
            }
        }
    }
}

TEST(MeetingSearch, StopsSoonWhenAskedTo) {
    for (const Mesh& mesh : meshes()) {
        for (const int asked_before : {0, 1, 5}) {
            std::atomic<int> asked = 0;
            std::size_t found = 0;
            const StopCheck stop = [&] { return asked++ >= asked_before; };
            EXPECT_FALSE(search_self_intersections(
                mesh, {{}, stop, serial_for},
                [&](std::span<const TriangleMeeting> some) { found += some.size(); }));
            // 512 steps a question, each of a leaf pair at most with 64 pairs of triangles.
            EXPECT_LT(found, 64U * 512 * static_cast<unsigned>(asked_before + 1));
            EXPECT_LT(asked, asked_before + 1000);
        }
    }
}

void expect_same(const DefectReport& a, const DefectReport& b) {
    ASSERT_EQ(a.findings.size(), b.findings.size());
    for (std::size_t i = 0; i < a.findings.size(); ++i) {
        const Finding &x = a.findings[i], &y = b.findings[i];
        EXPECT_EQ(x.rule, y.rule);
        EXPECT_EQ(x.count, y.count);
        EXPECT_EQ(x.is_lower_bound, y.is_lower_bound);
        ASSERT_EQ(x.places.size(), y.places.size());
        for (std::size_t k = 0; k < x.places.size(); ++k) {
            EXPECT_EQ(x.places[k].triangles, y.places[k].triangles);
            EXPECT_EQ(x.places[k].measure, y.places[k].measure);
        }
    }
    EXPECT_EQ(a.crossings_complete, b.crossings_complete);
    for (std::size_t i = 0; i < a.verdicts.size(); ++i) {
        EXPECT_EQ(a.verdicts[i].facts, b.verdicts[i].facts);
        EXPECT_EQ(a.verdicts[i].promises, b.verdicts[i].promises);
    }
}

bool is_about_pairs(Rule rule) {
    return rule == Rule::crossing_triangles || rule == Rule::touching_triangles ||
           rule == Rule::coplanar_overlap || rule == Rule::overlapping_components;
}

// By definition: fewer pairs than there are, and flagged so; nothing else changes.
TEST(FindDefects, AtALimitOfPairsCountsAreLowerBounds) {
    const TriangleSoup soup = test::soup_of(test::joined(
        test::coplanar_soup(kSearchSeed, 1000), test::moved_by(test::unit_cube(), 1, {5, 5, 5})));
    DefectOptions options;
    const DefectReport all = find_defects(soup, options);
    EXPECT_TRUE(all.crossings_complete);
    options.max_pairs = 1000;
    const DefectReport some = find_defects(soup, options);
    EXPECT_FALSE(some.crossings_complete);
    EXPECT_GE(some.counts.self_intersecting_pairs, 1000U);
    EXPECT_LT(some.counts.self_intersecting_pairs, all.counts.self_intersecting_pairs);
    EXPECT_EQ(some.counts.boundary_edges, all.counts.boundary_edges);
    std::size_t flagged = 0;
    for (const Finding& finding : some.findings) {
        EXPECT_EQ(finding.is_lower_bound, is_about_pairs(finding.rule)) << id_of(finding.rule);
        flagged += finding.is_lower_bound ? 1 : 0;
    }
    EXPECT_EQ(flagged, 2U) << "overlaps, and overlapping components";
    for (const Finding& finding : all.findings) EXPECT_FALSE(finding.is_lower_bound);
    for (const unsigned threads : {2U, 8U}) {
        const test::Team team(threads);
        options.parallel_for = team;
        expect_same(find_defects(soup, options), some);
    }
}

// The cube is sound and nothing meets it, but not every pair was examined.
TEST(FindDefects, AtALimitNoComponentIsCalledFreeOfCrossings) {
    const TriangleSoup soup = test::soup_of(test::joined(
        test::moved_by(test::unit_cube(), 1, {5, 5, 5}), test::coplanar_soup(kSearchSeed, 1000)));
    const DefectReport all = find_defects(soup);
    ASSERT_TRUE(all.verdicts[1].promises & format::promise_simple_solid);
    DefectOptions options;
    options.max_pairs = 1000;
    const DefectReport some = find_defects(soup, options);
    EXPECT_FALSE(some.verdicts[1].promises & format::promise_simple_solid);
    EXPECT_FALSE(some.verdicts[1].facts & format::verdict_crossings_examined);
    // Of the whole it is known that it crosses itself.
    EXPECT_TRUE(some.verdicts[0].facts & format::verdict_crossings_examined);
    EXPECT_TRUE(some.verdicts[0].facts & format::verdict_self_crossing);
}

// A cube in a cube counts as nested only when it is known that they do not overlap.
TEST(FindDefects, AtALimitNoComponentIsCalledNested) {
    const TriangleSoup soup =
        test::soup_of(test::joined(test::joined(test::moved_by(test::unit_cube(), 3, {9, 9, 9}),
                                                test::moved_by(test::unit_cube(), 1, {10, 10, 10})),
                                   test::coplanar_soup(kSearchSeed, 1000)));
    DefectOptions options;
    EXPECT_EQ(find_defects(soup, options).counts.nested_components, 1U);
    options.max_pairs = 1000;
    EXPECT_EQ(find_defects(soup, options).counts.nested_components, 0U);
    options.max_pairs = kDefaultMaxPairs;
    options.max_steps = 10;
    const DefectReport short_of_steps = find_defects(soup, options);
    EXPECT_EQ(short_of_steps.counts.nested_components, 0U);
    EXPECT_FALSE(short_of_steps.crossings_complete);
    options.max_steps = 0;
    EXPECT_TRUE(find_defects(soup, options).crossings_complete);
}

}  // namespace
}  // namespace cdprep::mesh
