// SPDX-License-Identifier: MIT
#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cells/cell_storage.h"
#include "support/brute_force.h"
#include "support/every_structure.h"
#include "support/guarded_pages.h"
#include "support/hard_meshes.h"
#include "support/hard_placements.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/tiny_pieces.h"
#include "support/waiting_leaves.h"

namespace cdprep::test {
namespace {

constexpr std::array kStructures = {Structure::octree, Structure::adaptive_octree,
                                    Structure::tetra_tree, Structure::pieces};
constexpr std::array kDescents = {Descent::larger, Descent::a_first, Descent::b_first,
                                  Descent::both};
constexpr std::array kLeafTests = {LeafTest::guigue_devillers, LeafTest::feito_torres};

struct Limits {
    std::uint32_t level = 3;
    std::uint32_t threshold = 1;
    format::SplitRule rule = format::SplitRule::median;
    format::TetraBounding bounding = format::TetraBounding::boxes;
    bool boxes = false;  ///< around what octrees' cells hold
};

/// With an octree, an adaptive octree, a tetra-tree and pieces.
AlignedBytes with_all(const AlignedBytes& file, const Limits& limits) {
    const auto boxes_in = limits.boxes ? std::optional(build::Frame{}) : std::nullopt;
    const AlignedBytes octree = with_octree(
        file, {.level = limits.level, .threshold = limits.threshold, .boxes_in = boxes_in});
    const AlignedBytes adaptive = with_adaptive_octree(octree, {.level = limits.level,
                                                                .threshold = limits.threshold,
                                                                .rule = limits.rule,
                                                                .boxes_in = boxes_in});
    return with_piece_tree(
        with_tetra_tree(adaptive, {.level = std::min(limits.level, format::kMaxTetraLevel),
                                   .threshold = limits.threshold,
                                   .bounding = limits.bounding}));
}

OpenModel open_all(const TestMesh& mesh, const Limits& limits, const TinyOptions& options = {}) {
    return open_tiny(with_all(bake_tiny(mesh.positions, mesh.triangles, options), limits));
}

using Pairs = std::vector<TrianglePair>;

std::string name_of(const StructureOptions& through) {
    return "structure " + std::to_string(static_cast<int>(through.structure)) + ", descent " +
           std::to_string(static_cast<int>(through.descent)) + ", test " +
           std::to_string(static_cast<int>(through.leaf_test));
}

/// In which the two differ first.
std::string first_difference(const Pairs& pairs, const Pairs& expected) {
    const auto [at, wanted] =
        std::mismatch(pairs.begin(), pairs.end(), expected.begin(), expected.end());
    const auto shown = [](const Pairs& list, Pairs::const_iterator pair) {
        if (pair == list.end()) return std::string("nothing");
        return std::to_string(pair->a) + "-" + std::to_string(pair->b);
    };
    return ", found " + shown(pairs, at) + ", expected " + shown(expected, wanted);
}

/// Every structure, descent and leaf test says what is expected; not each with each.
void expect_pairs(const Pairs& expected, const Model& a, const Model& b, const Placement& placement,
                  Workspace& workspace, const PairOptions& options = {}) {
    for (const Structure structure : kStructures) {
        for (const Descent descent : kDescents) {
            for (const LeafTest leaf_test : kLeafTests) {
                if (leaf_test == LeafTest::feito_torres && descent != Descent::both) continue;
                const StructureOptions through = {structure, leaf_test, descent};
                const Pairs pairs = pairs_through(through, a, b, placement, workspace, options);
                ASSERT_EQ(pairs.size(), expected.size())
                    << name_of(through) << first_difference(pairs, expected);
                ASSERT_TRUE(pairs == expected)
                    << name_of(through) << first_difference(pairs, expected);
                ASSERT_EQ(any_overlap_through({a, b, placement, options}, through, workspace),
                          !expected.empty())
                    << name_of(through);
            }
        }
    }
}

Pairs exchanged(Pairs pairs) {
    for (TrianglePair& pair : pairs) std::swap(pair.a, pair.b);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// The oracle: brute force by the six-segment test. Unequal depths; all ways to place.
TEST(OverlapThroughLaws, AgreesWithBruteForce) {
    constexpr std::uint32_t kSeed = 5;
    const int kRounds = kSlowdown == 1 ? 24 : 12;  // each kind of boxes of cones
    std::mt19937 random(kSeed);
    std::size_t touching = 0, asked = 0, none = 0, placed = 0;
    Workspace workspace(cells());
    for (int round = 0; round < kRounds; ++round) {
        SCOPED_TRACE("seed " + std::to_string(kSeed) + ", round " + std::to_string(round));
        const bool coarse = round % 2 == 0;
        const auto mesh = [&] {
            return coarse ? coarse_grid_soup(random(), 40, 2) : random_soup(random(), 60, 0.2);
        };
        const TestMesh a = mesh(), b = mesh();
        const Limits limits_a = {static_cast<std::uint32_t>(round % 4), 1U + round % 7,
                                 format::SplitRule{static_cast<std::uint32_t>(round / 2 % 2)},
                                 format::TetraBounding{static_cast<std::uint32_t>(round / 4 % 3)},
                                 round % 3 != 0};
        const Limits limits_b = {
            static_cast<std::uint32_t>(round % 3), 3, format::SplitRule::median,
            format::TetraBounding{static_cast<std::uint32_t>(round % 3)}, round % 5 < 3};
        const OpenModel model_a = open_all(a, limits_a, {.double_precision = round % 3 == 0});
        const OpenModel model_b = open_all(b, limits_b);
        const Pose p = round % 4 == 0 ? Pose() : random_pose(random, coarse ? 3 : 1.5);
        const Pose q = random_pose(random, 1);
        for (const Placement& placement : {Placement::b_moves(p), Placement::a_moves(p),
                                           Placement::world(p, q), Placement::world(q, q)}) {
            const Pairs expected = brute_force_pairs(a, b, placement);
            expect_pairs(expected, model_a.model, model_b.model, placement, workspace);
            touching += expected.size();
            asked += a.triangles.size() * b.triangles.size();
            none += expected.empty() ? 1 : 0;
            ++placed;
        }
    }
    // Neither answer may be rare, or this test would prove nothing.
    EXPECT_GT(touching, asked / 200);
    EXPECT_LT(touching, asked / 2);
    EXPECT_LT(none, placed / 2);
}

// The same pairs as the hierarchy's, for two surfaces in many poses; some touch nothing.
TEST(OverlapThroughLaws, AgreesWithTheHierarchyInRandomPoses) {
    std::mt19937 random(9);
    const OpenModel a = open_all(icosphere(4), {.level = 4, .threshold = 8, .boxes = true});
    const OpenModel b =
        open_all(torus(1, 0.3, 48, 24), {.level = 5, .threshold = 16, .boxes = true},
                 {.double_precision = true});
    Workspace workspace(cells());
    const int poses = rounds(200, 1);
    int hits = 0;
    for (int round = 0; round < poses; ++round) {
        const Placement placement = Placement::b_moves(random_pose(random, 2.2));
        const Pairs expected = all_pairs(a.model, b.model, placement, workspace);
        hits += expected.empty() ? 0 : 1;
        for (const Structure structure : kStructures) {
            const StructureOptions through = {structure, LeafTest::guigue_devillers,
                                              kDescents[static_cast<std::size_t>(round % 4)]};
            ASSERT_EQ(pairs_through(through, a.model, b.model, placement, workspace), expected)
                << name_of(through) << ", round " << round;
            ASSERT_EQ(any_overlap_through({a.model, b.model, placement}, through, workspace),
                      !expected.empty())
                << name_of(through) << ", round " << round;
        }
    }
    EXPECT_GT(hits, poses * 3 / 10);
    EXPECT_LT(hits, poses * 7 / 10);
}

// The same where cells list thousands of triangles: each of many blocks of a list is held
// against each of the other's.
TEST(OverlapThroughLaws, CellsThatListThousandsOfTrianglesHaveTheirPairs) {
    std::mt19937 random(19);
    Workspace workspace(cells());
    for (const std::uint32_t level : {0U, 1U}) {
        const OpenModel a = open_all(icosphere(4), {.level = level, .threshold = 8});
        const OpenModel b = open_all(torus(1, 0.3, 64, 32), {.level = level, .threshold = 8});
        std::size_t found = 0;
        for (int round = 0; round < 10; ++round) {
            const Placement placement = Placement::b_moves(random_pose(random, 1.5));
            const Pairs expected = all_pairs(a.model, b.model, placement, workspace);
            expect_pairs(expected, a.model, b.model, placement, workspace);
            if (::testing::Test::HasFatalFailure()) return;
            found += expected.size();
        }
        EXPECT_GT(found, 1000U);
    }
}

// Leaves of pieces are put together in fewer places than there are leaves. Those of a pair that
// waits to be tested must not give way to others, also where a batch was tested amid a pair.
TEST(OverlapThroughLaws, PiecesKeepWaitingLeaves) {
    const WaitingLeaves leaves = waiting_leaves(64, 3000);
    Workspace workspace(cells());
    const Pairs expected = pairs_in_leaves(leaves, 1, workspace);
    EXPECT_GT(expected.size(), 1000u);
    const Pairs pairs = pairs_in_leaves(leaves, kernels::kLeafBatch, workspace);
    EXPECT_TRUE(pairs == expected) << first_difference(pairs, expected);
}

// Where libraries in use lose pairs; the hierarchy is held against exact numbers there.
TEST(OverlapThroughLaws, HardPlacementsHaveTheirPairs) {
    Workspace workspace(cells());
    for (const HardPlacement& p : hard_placements()) {
        SCOPED_TRACE(p.name);
        const OpenModel a = open_all(p.a, {.level = 3, .boxes = true}, {.double_precision = true});
        const OpenModel b =
            open_all(p.b, {.level = 4, .threshold = 4, .boxes = true}, {.double_precision = true});
        const Pairs expected = all_pairs(a.model, b.model, p.placement, workspace);
        ASSERT_EQ(expected.size(), p.pairs);
        const Placement back = p.placement.a_is_moved()
                                   ? Placement::world(p.placement.pose_b(), p.placement.pose_a())
                                   : Placement::a_moves(p.placement.pose_b());
        if (p.a.triangles.size() * p.b.triangles.size() < 200'000) {
            expect_pairs(expected, a.model, b.model, p.placement, workspace);
        }
        for (const Structure structure : kStructures) {
            const StructureOptions through = {.structure = structure};
            ASSERT_EQ(pairs_through(through, a.model, b.model, p.placement, workspace), expected)
                << name_of(through);
            ASSERT_EQ(pairs_through(through, b.model, a.model, back, workspace),
                      exchanged(expected))
                << name_of(through);
        }
    }
}

// A pair is one answer when there is next to no room to remember answers: the first pair
// of cells that list both owns it. The oracle is the same question with room.
TEST(OverlapThroughLaws, EachPairIsOneAnswerWithoutRoom) {
    std::mt19937 random(77);
    Workspace workspace(cells());
    Workspace narrow(cells());
    cells_of(narrow.storage()).tested_pairs.limit(1);  // eight pairs of leaves
    std::size_t count = 0;
    for (int round = 0; round < 6; ++round) {
        const bool soup = round % 2 == 0;
        const TestMesh a = soup ? coarse_grid_soup(random(), 24, 3) : icosphere(1);
        const TestMesh b = soup ? coarse_grid_soup(random(), 50, 3) : torus(1, 0.25, 12, 6);
        const OpenModel model_a = open_all(a, {.level = 1, .boxes = true});
        const OpenModel model_b = open_all(b, {.level = 2, .threshold = 5, .boxes = true});
        const Placement placement =
            Placement::b_moves(round < 4 ? Pose() : random_pose(random, 0.5));
        const Pairs expected = all_pairs(model_a.model, model_b.model, placement, workspace);
        for (const Structure structure : kStructures) {
            for (const LeafTest leaf_test : kLeafTests) {
                const StructureOptions through = {structure, leaf_test,
                                                  kDescents[static_cast<std::size_t>(round % 4)]};
                const Pairs pairs =
                    pairs_through(through, model_a.model, model_b.model, placement, narrow);
                ASSERT_TRUE(pairs == expected)
                    << name_of(through) << first_difference(pairs, expected);
            }
        }
        count += expected.size();
    }
    EXPECT_GT(count, 300u);
}

TEST(OverlapThroughLaws, OptionsMeanWhatTheyMeanForTheHierarchy) {
    std::mt19937 random(3);
    Workspace workspace(cells());
    std::size_t closed = 0, others = 0;
    for (int round = 0; round < 10; ++round) {
        const OpenModel a = open_all(coarse_grid_soup(random(), 50, 2), {.level = 2});
        const OpenModel b = open_all(coarse_grid_soup(random(), 50, 2), {.level = 1});
        const Placement placement = Placement::b_moves(Pose());
        for (const Overlap overlap : {Overlap::closed, Overlap::proper}) {
            for (const Degenerate degenerate : {Degenerate::keep, Degenerate::skip}) {
                const PairOptions options = {.overlap = overlap, .degenerate = degenerate};
                const Pairs expected = all_pairs(a.model, b.model, placement, workspace, options);
                expect_pairs(expected, a.model, b.model, placement, workspace, options);
                (overlap == Overlap::closed && degenerate == Degenerate::keep ? closed : others) +=
                    expected.size();
            }
        }
    }
    EXPECT_LT(others, 3 * closed);
    EXPECT_GT(others, closed);
}

TEST(OverlapThroughLaws, ShortSpansKeepTheSmallest) {
    const OpenModel a = open_all(icosphere(2), {.level = 2});
    const OpenModel b = open_all(torus(1, 0.25, 16, 8), {.level = 3});
    Workspace workspace(cells());
    const Placement placement = Placement::b_moves(Pose());
    const Pairs all = all_pairs(a.model, b.model, placement, workspace);
    ASSERT_GT(all.size(), 20u);
    for (const Structure structure : kStructures) {
        const StructureOptions through = {.structure = structure};
        Pairs some(7);
        EXPECT_EQ(overlaps_through({a.model, b.model, placement}, through, workspace, some),
                  all.size());
        EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
    }
}

// B12: a triangle with corners far outside passes through cells in which it has none.
TEST(OverlapThroughLaws, LargeTrianglesMeetSmallCells) {
    const TestMesh small = icosphere(3);
    const TestMesh large = {{{-10, -8, 0.1}, {10, -9, 0.2}, {0.5, 10, -0.1}}, {{{0, 1, 2}}}};
    const OpenModel a = open_all(small, {.level = 5});
    const OpenModel b = open_all(large, {.level = 5, .boxes = true});
    Workspace workspace(cells());
    const Placement still = Placement::b_moves(Pose());
    const Pairs expected = brute_force_pairs(small, large, still);
    ASSERT_GT(expected.size(), 50u);
    expect_pairs(expected, a.model, b.model, still, workspace);
    expect_pairs(exchanged(expected), b.model, a.model, still, workspace);
}

// B13: planes of cells, faces of cones, the centre itself, which fans hold.
TEST(OverlapThroughLaws, TrianglesOnCellBoundariesAreOneAnswerEach) {
    const TestMesh planes = triangles_on_cell_planes();
    const TestMesh around = joined(planes, in_floats(fan(12)));
    Workspace workspace(cells());
    for (const std::uint32_t level : {1U, 3U}) {
        const OpenModel a = open_all(around, {.level = level, .boxes = level % 2 == 0});
        const OpenModel b = open_all(planes, {.level = 2, .threshold = 2});
        for (const Placement& placement :
             {Placement::b_moves(Pose()),
              Placement::b_moves(Pose::from_quaternion(1, 0, 0, 1, {0, 1, 0}).value())}) {
            const Pairs expected = brute_force_pairs(around, planes, placement);
            ASSERT_GT(expected.size(), 20u);
            expect_pairs(expected, a.model, b.model, placement, workspace);
            expect_pairs(brute_force_pairs(around, around, placement), a.model, a.model, placement,
                         workspace);
        }
    }
}

// B11: trivial meshes.
TEST(OverlapThroughLaws, TrivialMeshesHaveAnswers) {
    const std::array<TestMesh, 5> meshes = {
        TestMesh{}, TestMesh{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{{0, 1, 2}}, {{0, 0, 0}}}},
        TestMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}}}, grid_sheet(6, 6),
        copies_of_one_triangle(40)};
    Workspace workspace(cells());
    for (const TestMesh& a : meshes) {
        for (const TestMesh& b : meshes) {
            const OpenModel model_a = open_all(a, {.level = 4, .boxes = true});
            const OpenModel model_b = open_all(b, {.level = 2});
            const Placement still = Placement::b_moves(Pose());
            expect_pairs(brute_force_pairs(a, b, still), model_a.model, model_b.model, still,
                         workspace);
        }
    }
}

// Scale and place change nothing, by powers of two exactly: from 2^-900 to 2^900, and
// where a model of extent 1e-3 lies 1e6 away.
TEST(OverlapThroughLaws, AnyScaleAndPlaceAnswersAlike) {
    Workspace workspace(cells());
    const TestMesh a = icosphere(2), b = torus(1, 0.25, 16, 8);
    const Placement still = Placement::b_moves(Pose());
    const Pairs expected = brute_force_pairs(a, b, still);
    ASSERT_GT(expected.size(), 50u);
    for (const int exponent : {-900, -40, 0, 60, 900}) {
        const double scale = std::ldexp(1.0, exponent);
        const OpenModel model_a = open_all(moved_by(a, scale, {0, 0, 0}),
                                           {.level = 4, .boxes = true}, {.double_precision = true});
        const OpenModel model_b = open_all(moved_by(b, scale, {0, 0, 0}),
                                           {.level = 3, .boxes = true}, {.double_precision = true});
        SCOPED_TRACE(exponent);
        expect_pairs(expected, model_a.model, model_b.model, still, workspace);
    }
    const TestMesh far_a = moved_by(a, 1e-3, {1e6, -1e6, 1e6});
    const TestMesh far_b = moved_by(b, 1e-3, {1e6, -1e6, 1e6});
    const OpenModel model_a =
        open_all(far_a, {.level = 6, .boxes = true}, {.double_precision = true});
    const OpenModel model_b = open_all(far_b, {.level = 5}, {.double_precision = true});
    expect_pairs(brute_force_pairs(far_a, far_b, still), model_a.model, model_b.model, still,
                 workspace);
    // One of them 2^80 times as large as the other.
    const TestMesh tiny = moved_by(b, 0x1p-80, {0, 0, 1});
    const OpenModel model_tiny =
        open_all(tiny, {.level = 3, .boxes = true}, {.double_precision = true});
    const OpenModel sphere = open_all(a, {.level = 4}, {.double_precision = true});
    expect_pairs(brute_force_pairs(a, tiny, still), sphere.model, model_tiny.model, still,
                 workspace);
}

// By the table of needs: a file without a structure does not serve questions through it.
TEST(OverlapThroughLawsDeathTest, QuestionsStopWhereAModelWasNotBakedForThem) {
    const OpenModel with = open_all(icosphere(2), {});
    const OpenModel without = open_tiny(icosphere(2));
    Workspace workspace(cells());
    const Placement still = Placement::b_moves(Pose());
    for (const Structure structure : kStructures) {
        const StructureOptions through = {.structure = structure};
        if (structure == Structure::bvh) continue;
        EXPECT_DEATH(
            (void)any_overlap_through({with.model, without.model, still}, through, workspace),
            " needs section");
        EXPECT_DEATH((void)pairs_through(through, without.model, with.model, still, workspace),
                     " needs section");
    }
    EXPECT_EQ(pairs_through({}, with.model, without.model, still, workspace),
              all_pairs(with.model, without.model, still, workspace));
}

// The mapped file is what is asked: on read-only pages, with every section that
// the table of needs does not name closed.
TEST(OverlapThroughLaws, ReadOnlyTheSectionsThatTheyName) {
    const TestMesh mesh = icosphere(3);
    const AlignedBytes file =
        on_pages(with_all(bake_tiny(mesh.positions, mesh.triangles), {.level = 4, .threshold = 8}));
    const OpenModel whole = open_tiny(AlignedBytes(file.span()));
    Workspace workspace(cells());
    const Placement placement =
        Placement::b_moves(Pose::from_quaternion(1, 0.5, 0.25, 0.125, {0.5, 0.25, 0.125}).value());
    const Pairs expected = all_pairs(whole.model, whole.model, placement, workspace);
    ASSERT_FALSE(expected.empty());
    bool with_more = false;
    for (const Structure structure :
         {Structure::octree, Structure::adaptive_octree, Structure::tetra_tree,
          Structure::tetra_tree, Structure::pieces}) {
        format::SectionSet wanted = {SectionId::bvh_nodes, SectionId::bvh_leaves,
                                     SectionId::source_triangle, SectionId::positions_f32,
                                     SectionId::triangles};
        wanted.insert(find_needs(ask_of(structure))->needed);
        // The tetra-tree with boxes, and without.
        if (std::exchange(with_more, !with_more))
            wanted.insert(find_needs(ask_of(structure))->used);
        const GuardedPages pages(file.span(), wanted);
        EXPECT_GE(pages.guarded(), 5);
        const auto opened = Model::open(pages.bytes(), wanted);
        ASSERT_TRUE(opened) << opened.error().message;
        const Model& model = opened.value();
        const StructureOptions through = {.structure = structure};
        EXPECT_EQ(pairs_through(through, model, model, placement, workspace), expected);
        EXPECT_TRUE(any_overlap_through({model, model, placement}, through, workspace));
    }
}

// A model overlaps itself; that no triangle is named makes their numbers needless.
TEST(OverlapThroughLaws, WhetherAnyOverlapNeedsNoNumbersOfTriangles) {
    const TestMesh mesh = icosphere(2);
    const AlignedBytes plain =
        bake_tiny(mesh.positions, mesh.triangles, {.leave_out = {SectionId::source_triangle}});
    const OpenModel model = open_tiny(with_octree(plain, {.hashed = true}));
    ASSERT_FALSE(model.model.serves(Ask::overlap));
    Workspace workspace(cells());
    const Placement still = Placement::b_moves(Pose());
    for (const Structure structure :
         {Structure::bvh, Structure::octree, Structure::hashed_octree}) {
        EXPECT_TRUE(any_overlap_through({model.model, model.model, still}, {.structure = structure},
                                        workspace));
    }
}

}  // namespace
}  // namespace cdprep::test
