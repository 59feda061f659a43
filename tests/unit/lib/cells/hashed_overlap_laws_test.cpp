// SPDX-License-Identifier: MIT
#include "cells/hashed_overlap.h"

#include <gtest/gtest.h>

#include <array>

#include "cells/cell_storage.h"
#include "support/brute_force.h"
#include "support/every_structure.h"
#include "support/hard_placements.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"

namespace cdprep::test {
namespace {

StructureOptions hashed(CellSearch search, LeafTest leaf_test = LeafTest::guigue_devillers) {
    return {.structure = Structure::hashed_octree, .leaf_test = leaf_test, .search = search};
}

/// Both tests by every search give these pairs, and yes or no says the same.
void expect_pairs(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
                  const std::vector<TrianglePair>& expected, const PairOptions& options = {}) {
    for (const CellSearch search : kSearches) {
        for (const LeafTest test : {LeafTest::guigue_devillers, LeafTest::feito_torres}) {
            const StructureOptions through = hashed(search, test);
            ASSERT_TRUE(pairs_through(through, a, b, placement, workspace, options) == expected)
                << "search " << static_cast<int>(search) << ", test " << static_cast<int>(test);
            ASSERT_EQ(any_overlap_through({a, b, placement, options}, through, workspace),
                      !expected.empty());
        }
    }
}

/// Levels and thresholds from one cell to the deepest, with boxes and without.
build::OctreeOptions some_octree(std::mt19937& random) {
    constexpr std::array<std::uint32_t, 6> kLevels = {0, 1, 2, 3, 5, 7};
    return {.level = kLevels[random() % kLevels.size()],
            .threshold = 1 + static_cast<std::uint32_t>(random() % 20),
            .boxes_in = random() % 2 == 0 ? std::optional(build::Frame{}) : std::nullopt};
}

// The oracle: brute force by the six-segment test, and the hierarchy's answer. Fine and
// coarse meshes of unlike sizes, so that either model's octree is taken; all placements;
// every search and both tests.
TEST(HashedOverlapLaws, AgreesWithBruteForce) {
    constexpr std::uint32_t kSeed = 20261122;
    constexpr int kRounds = 40;
    std::mt19937 random(kSeed);
    std::size_t hits = 0, asked = 0;
    Workspace workspace(cells());
    for (int round = 0; round < kRounds; ++round) {
        const bool coarse = round % 2 == 0;
        const int more = round % 3 == 0 ? 60 : 0;
        const TestMesh a = coarse ? coarse_grid_soup(random(), 20 + more, 3)
                                  : random_soup(random(), 40 + more, 0.15);
        const TestMesh b =
            coarse ? coarse_grid_soup(random(), 40, 3) : random_soup(random(), 60, 0.15);
        const OpenModel model_a =
            open_with_octree(a, some_octree(random), {.double_precision = round % 3 == 0});
        const OpenModel model_b = open_with_octree(b, some_octree(random));
        const double reach = coarse ? 8 : 2.2;
        const Pose p = round % 8 == 0 ? Pose() : random_pose(random, reach);
        const Pose q = random_pose(random, 1);
        for (const Placement& placement :
             {Placement::b_moves(p), Placement::a_moves(p), Placement::relative(p, q),
              Placement::world(p, q), Placement::world(q, q)}) {
            const auto expected = brute_force_pairs(a, b, placement);
            ASSERT_EQ(all_pairs(model_a.model, model_b.model, placement, workspace), expected);
            SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", round " << round);
            expect_pairs(model_a.model, model_b.model, placement, workspace, expected);
            if (::testing::Test::HasFatalFailure()) return;
            hits += expected.empty() ? 0 : 1;
            ++asked;
        }
    }
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 9 / 10);
}

// The hierarchy's answer, on closed surfaces that cross, with every kind of bounds in the
// file and without; what counts as an overlap is the same too.
TEST(HashedOverlapLaws, AgreesWithTheHierarchyWhateverBoundsTheFileHas) {
    std::mt19937 random(17);
    const TestMesh a = icosphere(4), b = torus(1, 0.25, 40, 20);
    std::size_t found = 0, missed = 0;
    Workspace workspace(cells());
    for (const build::BvhBounds bounds :
         {build::BvhBounds::aligned, build::BvhBounds::oriented, build::BvhBounds::swept_lines}) {
        const OpenModel model_a = open_with_octree(
            a, {.level = 6, .threshold = 8, .boxes_in = build::Frame{}}, {.bounds = bounds});
        const OpenModel model_b =
            open_with_octree(b, {.level = 5, .threshold = 30}, {.bounds = bounds});
        for (int round = 0; round < 12; ++round) {
            const Placement placement = Placement::b_moves(random_pose(random, 1.5));
            for (const Overlap overlap : {Overlap::closed, Overlap::proper}) {
                const PairOptions options = {.overlap = overlap, .degenerate = Degenerate::skip};
                const auto expected =
                    all_pairs(model_a.model, model_b.model, placement, workspace, options);
                expect_pairs(model_a.model, model_b.model, placement, workspace, expected, options);
                if (::testing::Test::HasFatalFailure()) return;
                (expected.empty() ? missed : found) += 1;
            }
        }
    }
    EXPECT_GT(found, 30U);
    EXPECT_GT(missed, 4U);
}

// Where libraries in use report pairs that are none or lose pairs: the hierarchy's answer,
// which hard_placements_test holds against the definition.
TEST(HashedOverlapLaws, HardPlacementsHaveTheirPairs) {
    Workspace workspace(cells());
    for (const HardPlacement& p : hard_placements()) {
        SCOPED_TRACE(p.name);
        for (const std::uint32_t level : {2U, 7U}) {
            const build::OctreeOptions octree = {.level = level, .threshold = 4};
            const OpenModel a = open_with_octree(p.a, octree, {.double_precision = true});
            const OpenModel b = open_with_octree(p.b, octree, {.double_precision = true});
            const auto expected = all_pairs(a.model, b.model, p.placement, workspace);
            ASSERT_EQ(expected.size(), p.pairs);
            for (const CellSearch search : kSearches) {
                ASSERT_TRUE(pairs_through(hashed(search), a.model, b.model, p.placement,
                                          workspace) == expected);
            }
        }
    }
}

// A law: less room costs more passes and changes no pair.
TEST(HashedOverlapLaws, AnswersAreTheSameHoweverLittleRoomThereIs) {
    const TestMesh a = icosphere(4), b = icosphere(3);
    const OpenModel model_a = open_with_octree(a, {.level = 6, .threshold = 4});
    const OpenModel model_b = open_with_octree(b, {.level = 4, .threshold = 4});
    std::mt19937 random(23);
    std::size_t pairs = 0;
    for (int round = 0; round < 10; ++round) {
        const Placement placement = Placement::b_moves(random_pose(random, 0.5));
        Workspace roomy(cells());
        const auto expected = all_pairs(model_a.model, model_b.model, placement, roomy);
        for (const std::uint32_t room : {2U, 3U, 7U, 30U}) {
            Workspace workspace(cells());
            cells_of(workspace.storage()).candidate_nodes.set_room(room);
            expect_pairs(model_a.model, model_b.model, placement, workspace, expected);
            if (::testing::Test::HasFatalFailure()) return;
        }
        pairs += expected.size();
    }
    EXPECT_GT(pairs, 1000U);
}

// By construction: all pairs touch, far more nodes than there is room for meet one of the
// other model, and each pair comes once.
TEST(HashedOverlapLaws, MoreCandidatesThanThereIsRoomForComeOnce) {
    constexpr int kCopies = 34'000;
    static_assert(kCopies / 64 > CandidateNodes::kRoom);
    const TestMesh a = copies_of_one_triangle(kCopies), b = copies_of_one_triangle(3);
    const OpenModel model_a = open_with_octree(a, {.level = 3, .threshold = 1});
    const OpenModel model_b = open_with_octree(b, {.level = 3, .threshold = 1});
    Workspace workspace(cells());
    const auto pairs = pairs_through(hashed(CellSearch::sorted), model_a.model, model_b.model,
                                     Placement::b_moves(Pose()), workspace);
    EXPECT_EQ(pairs.size(), 3U * kCopies);
    EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace
}  // namespace cdprep::test
