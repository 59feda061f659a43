// SPDX-License-Identifier: MIT
#include "support/hard_placements.h"

#include <gtest/gtest.h>

#include "cdprep/pairs.h"
#include "cdprep/parallel.h"
#include "support/brute_force.h"
#include "support/exact_pairs.h"
#include "support/hard_triangles.h"
#include "support/open_tiny.h"
#include "support/run_threads.h"
#include "support/seed_mesh.h"

namespace cdprep::test {
namespace {

/// Whether one to eight threads give these pairs.
bool threads_agree(const Model& a, const Model& b, const Placement& placement,
                   const std::vector<TrianglePair>& expected) {
    std::vector<Workspace> workspaces(8);
    std::vector<TrianglePair> pairs(expected.size());
    for (std::size_t threads = 1; threads <= workspaces.size(); ++threads) {
        const auto workers = std::span(workspaces).first(threads);
        const std::size_t count = split_overlaps({a, b, placement}, workers, run_threads, pairs);
        if (count != expected.size() || pairs != expected) return false;
    }
    return true;
}

/// Asks for all pairs; swapped, with the same model moving, on many threads, and as a
/// mere yes or no the answer must be the same.
std::vector<TrianglePair> ask(const HardPlacement& p) {
    const OpenModel a = open_tiny(p.a, {.double_precision = true});
    const OpenModel b = open_tiny(p.b, {.double_precision = true});
    Workspace workspace;
    const auto pairs = all_pairs(a.model, b.model, p.placement, workspace);
    EXPECT_EQ(collide({a.model, b.model, p.placement}, workspace).hit == Answer::yes,
              !pairs.empty())
        << p.name;
    EXPECT_TRUE(threads_agree(a.model, b.model, p.placement, pairs)) << p.name;
    const Placement exchanged = p.placement.a_is_moved()
                                    ? Placement::world(p.placement.pose_b(), p.placement.pose_a())
                                    : Placement::a_moves(p.placement.pose_b());
    auto swapped = all_pairs(b.model, a.model, exchanged, workspace);
    for (TrianglePair& pair : swapped) std::swap(pair.a, pair.b);
    std::sort(swapped.begin(), swapped.end());
    EXPECT_TRUE(swapped == pairs) << p.name;
    return pairs;
}

/// The definition in exact numbers; for large meshes the six-segment test, which
/// triangle_contact_laws_test holds against the definition.
std::vector<TrianglePair> exact_pairs(const HardPlacement& p) {
    constexpr std::size_t kLarge = 250;
    if (p.a.triangles.size() < kLarge) return exact_pairs(p.a, p.b, p.placement).closed;
    return boxed_pairs(p.a, p.b, p.placement, triangles_touch_by_segments);
}

TEST(HardPlacements, HaveExactlyThePairsOfTheDefinition) {
    for (const HardPlacement& p : hard_placements()) {
        const auto pairs = ask(p);
        EXPECT_EQ(pairs.size(), p.pairs) << p.name;
        EXPECT_TRUE(pairs == exact_pairs(p)) << p.name;
    }
}

// The counts are those of CGAL's exact predicates.
TEST(HardPlacements, AHorseMeetsItselfWhereverItStands) {
    const auto horse = seed_mesh("horse");
    if (!horse) GTEST_SKIP() << "no test models beside this checkout";
    for (const HardPlacement& p : hard_placements_of(*horse)) {
        const auto pairs = ask(p);
        EXPECT_EQ(pairs.size(), p.pairs) << p.name;
        EXPECT_TRUE(pairs == exact_pairs(p)) << p.name;
    }
}

// A law: scaling and moving both change no pair of this pose, where nothing comes
// near enough to touching.
TEST(HardPlacements, SizeAndPlaceDoNotMatter) {
    const auto armadillo = seed_mesh("armadillo"), horse = seed_mesh("horse");
    if (!armadillo || !horse) GTEST_SKIP() << "no test models beside this checkout";
    std::vector<TrianglePair> control;
    for (const HardPlacement& p : hard_placements_of(*armadillo, *horse)) {
        const auto pairs = ask(p);
        EXPECT_EQ(pairs.size(), p.pairs) << p.name;
        if (control.empty()) control = pairs;
        EXPECT_TRUE(pairs == control) << p.name;
    }
}

/// One triangle a model.
HardPlacement as_models(const HardPair& pair) {
    const auto mesh = [](const Corners& t) { return TestMesh{{t[0], t[1], t[2]}, {{{0, 1, 2}}}}; };
    return {pair.id, mesh(pair.a), mesh(pair.b), Placement::b_moves(Pose()),
            pair.closed ? std::size_t{1} : 0};
}

void expect_answer(const HardPair& pair) {
    const HardPlacement p = as_models(pair);
    ASSERT_EQ(ask(p).size(), p.pairs) << p.name;
    const OpenModel a = open_tiny(p.a, {.double_precision = true});
    const OpenModel b = open_tiny(p.b, {.double_precision = true});
    Workspace workspace;
    const PairOptions proper = {.overlap = Overlap::proper};
    ASSERT_EQ(overlaps({a.model, b.model, p.placement, proper}, workspace, {}),
              pair.proper ? 1U : 0U)
        << p.name;
}

// T01 to T23, asked as models: boxes, leaves and filters may not add or lose any.
TEST(HardPlacements, TrianglesOfTheCatalogueAnswerAsModels) {
    std::size_t asked = 0, hits = 0;
    const auto expect = [&](const HardPair& pair) {
        expect_answer(pair);
        ++asked;
        hits += pair.closed ? 1 : 0;
    };
    for (const HardPair& pair : hard_triangles()) {
        for (std::size_t i = 0; i < kRelabellings; i += 5) expect(relabelled(pair, i));
        for (std::size_t i = 0; i < kAxisTurns; i += 5) expect(turned(pair, i));
        for (const int exponent : {-1060, -300, -40, -20, 20, 40, 300, 900}) {
            if (const auto changed = scaled(pair, exponent)) expect(*changed);
        }
        for (const double shift : {0x1p20, 0x1p40}) {
            if (const auto changed = shifted(pair, shift)) expect(*changed);
        }
    }
    EXPECT_GT(asked, 1500U);
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 9 / 10);
}

}  // namespace
}  // namespace cdprep::test
