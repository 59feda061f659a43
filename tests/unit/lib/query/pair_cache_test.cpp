// SPDX-License-Identifier: MIT
#include "cdprep/advanced/pair_cache.h"

#include <gtest/gtest.h>

#include <random>

#include "cdprep/advanced/query_counts.h"
#include "cdprep/pairs.h"
#include "query/cached_search.h"
#include "support/meshes.h"
#include "support/open_tiny.h"

// What a cache saves, by counting. That no answer changes is shown by pair_cache_laws_test.cpp.

namespace cdprep::test {
namespace {

Placement along_x(double x) {
    return Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, 0, 0}).value());
}

/// The work of 100 queries, with a cache and without.
struct Work {
    QueryCounts cached, plain;
    PairCache cache;
    int hits = 0;
};

/// `ask(pair, workspace)` returns whether it found something; B starts at `x` and makes `step`s.
template <class Ask>
Work work_of(const Model& a, const Model& b, double x, double step, Ask ask) {
    Work work;
    Workspace with, without;
    with.count_into(&work.cached);
    without.count_into(&work.plain);
    for (int i = 0; i < 100; ++i, x += step) {
        const bool hit = ask(Pair{a, b, along_x(x)}, without);
        EXPECT_EQ(ask(Pair{a, b, along_x(x), {}, &work.cache}, with), hit) << i;
        work.hits += hit ? 1 : 0;
    }
    return work;
}

bool touch(const Pair& pair, Workspace& workspace) {
    return collide(pair, workspace).hit == Answer::yes;
}
bool overlap(const Pair& pair, Workspace& workspace) {
    return overlaps(pair, workspace, {}) > 0;
}
bool are_near(const Pair& pair, Workspace& workspace) {
    return within(pair, 0.25, workspace);
}
bool are_apart(const Pair& pair, Workspace& workspace) {
    return distance(pair, workspace)->lower > 0;
}

struct PairCacheSaves : testing::Test {
    OpenModel a = open_tiny(icosphere(3)), b = open_tiny(torus(1, 0.25, 40, 20));
};

// Two triangles that cross go on crossing for a while, and are asked first.
TEST_F(PairCacheSaves, AllBoxesWhileATouchLasts) {
    const Work work = work_of(a.model, b.model, 1.5, 1e-4, touch);
    EXPECT_EQ(work.hits, 100);
    EXPECT_LT(work.cached.box_pairs, work.plain.box_pairs / 10);
    EXPECT_LT(work.cached.leaf_pairs, work.plain.leaf_pairs / 10);
    EXPECT_GT(work.cached.leaf_pairs, 0u);  // of the first query
    EXPECT_EQ(work.cache.holds & held_touch, held_touch);
    EXPECT_EQ(work.cache.gap, 0);
}

// Where the pair has parted, its neighbours are asked before all others.
TEST_F(PairCacheSaves, MostBoxesWhereThePairParts) {
    const Work work = work_of(a.model, b.model, 1.5, 5e-3, touch);
    EXPECT_EQ(work.hits, 100);
    EXPECT_LT(work.cached.box_pairs, work.plain.box_pairs / 2);
}

// One proof of a gap of several steps answers the queries of these steps.
TEST_F(PairCacheSaves, AllBoxesWhileAProvenGapLasts) {
    const Work work = work_of(a.model, b.model, 2.26, 1e-3, touch);
    EXPECT_EQ(work.hits, 0);
    EXPECT_GT(work.plain.box_pairs, 100u);
    EXPECT_LT(work.cached.box_pairs, work.plain.box_pairs / 3);
    EXPECT_GT(work.cache.gap, 0);
}

// overlaps() seeks any contact first, and lists nothing while the gap that this proved lasts.
TEST_F(PairCacheSaves, AllBoxesOfOverlapsWhileAProvenGapLasts) {
    const Work work = work_of(a.model, b.model, 2.26, 1e-3, overlap);
    EXPECT_EQ(work.hits, 0);
    EXPECT_GT(work.plain.box_pairs, 100u);
    EXPECT_LT(work.cached.box_pairs, work.plain.box_pairs / 3);
}

// A pair within the tolerance is asked first.
TEST_F(PairCacheSaves, AllBoxesWhileAPairStaysNear) {
    const Work work = work_of(a.model, b.model, 2.3, 1e-3, are_near);
    EXPECT_EQ(work.hits, 100);
    EXPECT_LT(work.cached.box_pairs, work.plain.box_pairs / 10);
}

// within() proves no gap, but uses the one that distance() found.
TEST_F(PairCacheSaves, AllBoxesOfWithinAfterADistance) {
    Workspace workspace;
    PairCache cache;
    ASSERT_GT(distance({a.model, b.model, along_x(3.5), {}, &cache}, workspace)->lower, 1);
    QueryCounts counts;
    workspace.count_into(&counts);
    for (const double x : {3.4, 3.1, 2.8, 2.52}) {
        EXPECT_FALSE(are_near({a.model, b.model, along_x(x), {}, &cache}, workspace));
    }
    EXPECT_EQ(counts.box_pairs, 0u);
    EXPECT_FALSE(are_near({a.model, b.model, along_x(2.52)}, workspace));
    EXPECT_GT(counts.box_pairs, 0u);
}

// The last closest pair bounds the search from its start.
TEST_F(PairCacheSaves, MeasuringFromTheLastClosestPair) {
    const Work work = work_of(a.model, b.model, 3, 1e-3, are_apart);
    EXPECT_EQ(work.hits, 100);
    EXPECT_LT(work.cached.measured, work.plain.measured);
    EXPECT_EQ(work.cache.holds & held_pair, held_pair);
}

// By hand: two steps, or twice the last proof if that held; none while one waits.
TEST(PairCacheMargin, IsTwoStepsOrTwiceTheLastProof) {
    PairCache cache;
    cache.step = 3;
    cache.proof = 2;
    EXPECT_EQ(next_margin(cache), 6);
    cache.proof = 5;
    EXPECT_EQ(next_margin(cache), 10);
    cache.failures = 1;
    EXPECT_EQ(next_margin(cache), 6);
    cache.wait = 2;
    EXPECT_EQ(next_margin(cache), 0);
    EXPECT_EQ(next_margin(cache), 0);
    EXPECT_EQ(cache.wait, 0u);
    EXPECT_EQ(next_margin(cache), 6);
}

// By hand: each failure in a row waits four times as long, up to the fourth.
TEST(PairCacheMargin, WaitsLongerAfterEachFailure) {
    PairCache cache;
    for (const unsigned waits : {3u, 15u, 63u, 255u, 255u}) {
        note_proof(cache, 7, false);
        EXPECT_EQ(cache.wait, waits);
        EXPECT_EQ(cache.proof, 0);
    }
    note_proof(cache, 7, true);
    EXPECT_EQ(cache.wait, 0u);
    EXPECT_EQ(cache.failures, 0u);
    EXPECT_EQ(cache.proof, 7);
}

// A hint may be the pair of the last query, any other pair, or none that the models have.
TEST_F(PairCacheSaves, NoAnswerDependsOnAHint) {
    Workspace workspace;
    std::mt19937 random(7);
    int hits = 0;
    TreePair last = kNoPair;
    for (int i = 0; i < 300; ++i) {
        const Pair pair{a.model, b.model, along_x(1.2 + i * 0.005)};
        const bool expected =
            find_contact(pair.a, pair.b, pair.placement, workspace, {}).has_value();
        hits += expected ? 1 : 0;
        for (TreePair hint :
             {last, kNoPair, TreePair{0, b.model.triangle_count()},
              TreePair{static_cast<std::uint32_t>(random()) % a.model.triangle_count(),
                       static_cast<std::uint32_t>(random()) % b.model.triangle_count()}}) {
            ASSERT_EQ(any_contact_near(hint, pair, workspace), expected) << i;
            ASSERT_EQ(hint.a != kNoPair.a, expected);
            if (!expected) continue;
            const ContactTest touch(pair.a, pair.b, pair.placement, {}, nullptr);
            ASSERT_TRUE(touch(hint.a, hint.b, false)) << i;
            last = hint;
        }
    }
    EXPECT_GT(hits, 100);
    EXPECT_LT(hits, 300);
}

}  // namespace
}  // namespace cdprep::test
