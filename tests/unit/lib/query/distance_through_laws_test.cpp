// SPDX-License-Identifier: MIT
#include "cdprep/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cdprep/advanced/pair_front.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells/overlap_through.h"
#include "support/guarded_pages.h"
#include "support/hard_distances.h"
#include "support/hard_triangles.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/placements.h"
#include "support/random_pose.h"
#include "support/same_distance.h"
#include "support/tiny_pieces.h"

// The truth in all of these is what distance(), within() and overlaps() answer,
// whose own laws compare them with rational numbers.

namespace cdprep::test {
namespace {

constexpr PairOptions kThroughPieces = {.through = Structure::pieces};
constexpr StructureOptions kPieces = {.structure = Structure::pieces};

OpenModel open_pieces(const TestMesh& mesh, const TinyOptions& options = {}) {
    return open_tiny(with_piece_tree(bake_tiny(mesh.positions, mesh.triangles, options)));
}

/// The question through pieces, with a cache that may be null.
Pair through_pieces(const Model& a, const Model& b, const Placement& placement, PieceCache* cache) {
    if (cache == nullptr) return {a, b, placement, kThroughPieces};
    return {a, b, placement, kThroughPieces, &cache->pair, &cache->front};
}

/// Where models touch, many pairs do: any may answer.
void expect_alike(const std::optional<Distance>& expected, const std::optional<Distance>& found) {
    if (expected && found && expected->upper == 0) {
        ASSERT_EQ(found->upper, 0);
    } else {
        expect_same(expected, found);
    }
}

/// Both models with pieces, and what is asked of them.
struct Asked {
    OpenModel a;
    OpenModel b;
    Workspace workspace = {};
    std::size_t asked = 0;
    std::size_t hits = 0;

    [[nodiscard]] std::vector<TrianglePair> pairs(const StructureOptions& through,
                                                  const Placement& placement) {
        std::vector<TrianglePair> found(10'000);
        found.resize(overlaps_through({a.model, b.model, placement}, through, workspace, found));
        return found;
    }
    [[nodiscard]] std::vector<TrianglePair> near_pairs(const PairOptions& options,
                                                       const Placement& placement,
                                                       double tolerance) {
        std::vector<TrianglePair> found(10'000);
        found.resize(
            pairs_within({a.model, b.model, placement, options}, tolerance, workspace, found));
        return found;
    }
    /// Every question through pieces as through boxes, with a cache that may be null.
    void expect_same_answers(const Placement& placement, PieceCache* cache) {
        const Pair by_boxes = {a.model, b.model, placement};
        const Pair by_pieces = through_pieces(a.model, b.model, placement, cache);
        const auto truth = distance(by_boxes, workspace);
        expect_alike(truth, distance(by_pieces, workspace));
        if (::testing::Test::HasFatalFailure()) return;
        const double upper = truth ? truth->upper : 1;
        for (const double tolerance :
             {0.0, upper, std::nextafter(upper, 0.0), upper / 2, 2 * upper, -1.0}) {
            ASSERT_EQ(within(by_boxes, tolerance, workspace),
                      within(by_pieces, tolerance, workspace))
                << tolerance;
            ASSERT_EQ(near_pairs({}, placement, tolerance),
                      near_pairs(kThroughPieces, placement, tolerance))
                << tolerance;
            const DistanceOptions near = {.max_distance = tolerance};
            expect_alike(distance(by_boxes, workspace, near), distance(by_pieces, workspace, near));
            if (::testing::Test::HasFatalFailure()) return;
        }
        const auto found = pairs({}, placement);
        ASSERT_EQ(found, pairs(kPieces, placement));
        ASSERT_EQ(any_overlap_through(by_pieces, kPieces, workspace), !found.empty());
        ++asked;
        hits += found.empty() ? 0 : 1;
    }
};

TEST(DistanceThroughLaws, PiecesAnswerAsBoxesDo) {
    constexpr std::uint32_t kSeed = 20261121;
    std::mt19937 random(kSeed);
    std::size_t asked = 0, hits = 0;
    for (int round = 0; round < 200; ++round) {
        const bool coarse = round % 2 == 0;
        const int count = 1 + static_cast<int>(random() % 90);
        const auto soup = [&] {
            return coarse ? coarse_grid_soup(random(), count, 2)
                          : random_soup(random(), count, 0.2);
        };
        Asked pair{open_pieces(soup(), {.double_precision = round % 3 == 0}), open_pieces(soup())};
        for (int i = 0; i < 5; ++i) {
            const double reach = std::pow(10, static_cast<int>(random() % 4) - 1);
            const Pose p =
                coarse ? Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, reach, 0.5, 1}).value()
                       : random_pose(random, reach);
            pair.expect_same_answers(placement_of_kind(random(), p, random_pose(random, reach)),
                                     nullptr);
            ASSERT_FALSE(HasFatalFailure()) << "seed " << kSeed << ", round " << round;
        }
        asked += pair.asked;
        hits += pair.hits;
    }
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 7 / 10);
}

// One cache for all questions of a walk through touch, and for walks of other models after it.
TEST(DistanceThroughLaws, NoCacheChangesAnAnswer) {
    constexpr std::uint32_t kSeed = 7;
    std::mt19937 random(kSeed);
    PieceCache cache;
    std::size_t asked = 0, hits = 0;
    for (int round = 0; round < 24; ++round) {
        const bool coarse = round % 2 == 0;
        const auto mesh = [&] {
            return coarse ? coarse_grid_soup(random(), 40, 2) : torus(1, 0.25, 20, 10);
        };
        Asked pair{open_pieces(mesh()), open_pieces(coarse ? mesh() : icosphere(2))};
        const double step = coarse ? 0.375 : 0.25;
        Double3 at = {coarse ? -7.5 : -5.0, 0, 0};
        for (int i = 0; i < 40; ++i) {
            at.x += step;
            const double turn = i % 3 == 0 ? 0 : 0.002 * i;
            const Pose pose = Pose::from_quaternion(1, turn, -turn, turn, at).value();
            pair.expect_same_answers(Placement::b_moves(pose), &cache);
            ASSERT_FALSE(HasFatalFailure())
                << "seed " << kSeed << ", round " << round << ", step " << i;
        }
        asked += pair.asked;
        hits += pair.hits;
    }
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 7 / 10);
}

// A cache with any numbers at all is allowed, but for a front that is said to be of these models.
TEST(DistanceThroughLaws, ACacheOfNonsenseIsHarmless) {
    std::mt19937 random(11);
    Asked pair{open_pieces(icosphere(2)), open_pieces(torus(1, 0.25, 20, 10))};
    for (int round = 0; round < 100; ++round) {
        PieceCache cache;
        cache.pair.holds = 1 + 4 * (random() % 2);
        cache.pair.triangle_a = random();
        cache.pair.triangle_b = random() % 400;
        // Of other models, whatever it holds.
        cache.front.models = {random(), random()};
        cache.front.count = random() % 600;
        cache.front.begun_with = random() % 600;
        cache.front.failures = random() % 8;
        cache.front.wait = random() % 3;
        for (std::uint64_t& places : cache.front.pair) places = random();
        for (auto& row : cache.front.row) {
            for (float& number : row) number = static_cast<float>(random() % 9) - 4;
        }
        pair.expect_same_answers(Placement::b_moves(random_pose(random, 1.5)), &cache);
        ASSERT_FALSE(HasFatalFailure()) << round;
    }
}

/// Where B stands after `step` steps towards A, turning meanwhile.
Placement on_the_way(double from, double step, int i) {
    const double turn = 0.001 * i;
    return Placement::b_moves(
        Pose::from_quaternion(1, turn, 2 * turn, -turn, {from - step * i, 0.1, 0.05}).value());
}

// Poses that follow each other: planes of the first question answer most of the others.
TEST(DistanceThroughLaws, AFrontAnswersWhatFollows) {
    Asked pair{open_pieces(icosphere(2)), open_pieces(icosphere(2))};
    const Model &x = pair.a.model, &y = pair.b.model;
    PieceCache cache;
    QueryCounts plain, cached;
    std::size_t near = 0;
    constexpr int kSteps = 60;
    for (int i = 0; i < kSteps; ++i) {
        const Placement placement = on_the_way(2.1, 0.0005, i);
        pair.workspace.count_into(&plain);
        const auto truth = distance({x, y, placement, kThroughPieces}, pair.workspace);
        pair.workspace.count_into(i == 0 ? nullptr : &cached);
        expect_alike(truth, distance(through_pieces(x, y, placement, &cache), pair.workspace));
        ASSERT_FALSE(HasFatalFailure()) << i;
        pair.workspace.count_into(nullptr);
        const bool is_within = within(through_pieces(x, y, placement, &cache), 0.1, pair.workspace);
        ASSERT_EQ(is_within, truth->upper <= 0.1) << i;
        near += is_within ? 1 : 0;
    }
    EXPECT_GT(near, kSteps * 2U / 10);
    EXPECT_LT(near, kSteps * 8U / 10);
    EXPECT_GT(cache.front.count, 1U);
    EXPECT_EQ(cache.front.failures, 0U);
    EXPECT_GT(plain.box_pairs, 100U * kSteps);
    EXPECT_EQ(cached.box_pairs, 0U);  // no walk
}

// One plane tells that two balls are not near; for their distance more are wanted than there is
// room for: what has none is searched. From the beginning that is too much: it is given up.
TEST(DistanceThroughLaws, AFullFrontIsSearchedBelow) {
    Asked pair{open_pieces(icosphere(3)), open_pieces(icosphere(3))};
    const Model &x = pair.a.model, &y = pair.b.model;
    PieceCache cache;
    std::uint32_t most = 0, failures = 0;
    for (int i = 0; i < 12; ++i) {
        const Placement placement = on_the_way(2.1, 0.0005, i);
        const auto truth = distance({x, y, placement}, pair.workspace);
        for (const double tolerance : {truth->upper, 0.01}) {
            ASSERT_EQ(within(through_pieces(x, y, placement, &cache), tolerance, pair.workspace),
                      tolerance == truth->upper);
        }
        expect_alike(truth, distance(through_pieces(x, y, placement, &cache), pair.workspace));
        ASSERT_FALSE(HasFatalFailure()) << i;
        most = std::max(most, cache.front.count);
        failures = std::max(failures, cache.front.failures);
    }
    EXPECT_GT(most, kFrontRoom - format::kBvhWidth);
    EXPECT_GT(failures, 0U);
}

// Poses that have nothing to do with each other: it is given up, and tried less and less often.
TEST(DistanceThroughLaws, AFrontIsLostWhereModelsJump) {
    std::mt19937 random(13);
    Asked pair{open_pieces(icosphere(3)), open_pieces(torus(1, 0.25, 40, 20))};
    PieceCache cache;
    std::uint32_t most_failures = 0;
    for (int i = 0; i < 200; ++i) {
        const Placement placement = Placement::b_moves(random_pose(random, 2.2));
        expect_alike(distance({pair.a.model, pair.b.model, placement}, pair.workspace),
                     distance({pair.a.model, pair.b.model, placement, kThroughPieces, &cache.pair,
                               &cache.front},
                              pair.workspace));
        ASSERT_FALSE(HasFatalFailure()) << i;
        most_failures = std::max(most_failures, cache.front.failures);
    }
    EXPECT_GT(most_failures, 0U);
}

// X01: parallel faces; both in one turned pose.
TEST(DistanceThroughLaws, ParallelFacesKeepTheirGapWhenTurned) {
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0.5, -0.25, 2}).value();
    for (const double gap : {0x1p-3, 0x1p-20, 0x1p-40, 1e-12, 0.0}) {
        const TestMesh beside = cube_beside(gap);
        Asked pair{open_pieces(unit_cube(), {.double_precision = true}),
                   open_pieces(beside, {.double_precision = true})};
        pair.expect_same_answers(Placement::b_moves(Pose()), nullptr);
        pair.expect_same_answers(Placement::world(pose, pose), nullptr);
        const auto found =
            distance({pair.a.model, pair.b.model, Placement::b_moves(Pose()), kThroughPieces},
                     pair.workspace);
        EXPECT_NEAR(found->upper, gap, 1e-14);
    }
}

// X03 and X04: the catalogue's touching and degenerate triangles, and one step aside.
TEST(DistanceThroughLaws, HardTrianglesTouchOrDoNot) {
    for (const HardPair& hard : hard_triangles()) {
        const TestMesh a{{hard.a[0], hard.a[1], hard.a[2]}, {{{0, 1, 2}}}};
        for (const double step : {0.0, 0x1p-20, -0x1p-20}) {
            TestMesh b{{hard.b[0], hard.b[1], hard.b[2]}, {{{0, 1, 2}}}};
            for (Double3& p : b.positions) p = {p.x + step, p.y + step, p.z + step};
            Asked pair{open_pieces(a, {.double_precision = true}),
                       open_pieces(b, {.double_precision = true})};
            pair.expect_same_answers(Placement::b_moves(Pose()), nullptr);
            ASSERT_FALSE(HasFatalFailure()) << hard.id;
        }
    }
}

// X06: a gap of 1e-12 where a coordinate's last bit is 1e-10.
TEST(DistanceThroughLaws, CancellationChangesNothing) {
    for (const double gap : {1e-12, 1e-10, 3e-10, 1e-6}) {
        Asked pair{
            open_pieces(moved_by(unit_cube(), 1, {1e6, 1e6, 1e6}), {.double_precision = true}),
            open_pieces(moved_by(unit_cube(), 1, {1e6 + 1 + gap, 1e6 + 0.25, 1e6 + 0.125}),
                        {.double_precision = true})};
        PieceCache cache;
        for (int i = 0; i < 3; ++i) {
            pair.expect_same_answers(Placement::b_moves(Pose()), &cache);
            pair.expect_same_answers(
                Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, gap, 0, 0}).value()),
                &cache);
        }
    }
}

// X08: whatever is permitted is kept.
TEST(DistanceThroughLaws, PermittedErrorsAreKept) {
    std::mt19937 random(2);
    const OpenModel a = open_pieces(random_soup(random(), 60, 0.2));
    const OpenModel b = open_pieces(random_soup(random(), 60, 0.2));
    Workspace workspace;
    for (int round = 0; round < 50; ++round) {
        const Placement placement = Placement::b_moves(random_pose(random, 5));
        const auto best = distance({a.model, b.model, placement}, workspace);
        for (const double error : {1e-6, 1e-3, 0.1, 1.0}) {
            const auto found = distance({a.model, b.model, placement, kThroughPieces}, workspace,
                                        {.relative_error = error});
            EXPECT_LE(found->lower, best->upper);
            EXPECT_GE(found->upper, best->lower);
            EXPECT_LE(found->upper, found->lower * (1 + error) + 1e-12);
        }
    }
}

// X09: by hand, a cube of side 1 in the middle of one of side 3.
TEST(DistanceThroughLaws, ASolidInsideAnotherIsNotApart) {
    Asked pair{open_pieces(unit_cube()), open_pieces(moved_by(unit_cube(), 3, {-1, -1, -1}))};
    const Placement still = Placement::b_moves(Pose());
    PieceCache cache;
    pair.expect_same_answers(still, &cache);
    const auto solids = distance({pair.a.model,
                                  pair.b.model,
                                  still,
                                  {.body = Body::solid, .through = Structure::pieces},
                                  &cache.pair,
                                  &cache.front},
                                 pair.workspace, {.max_distance = 0.5});
    ASSERT_TRUE(solids);
    EXPECT_EQ(solids->upper, 0);
}

TEST(DistanceThroughLaws, SizeDoesNotMatter) {
    for (const double size : {0x1p-900, 0x1p-100, 1.0, 0x1p100, 0x1p900}) {
        Asked ball{open_pieces(moved_by(icosphere(2), size, {}), {.double_precision = true}),
                   open_pieces(moved_by(icosphere(2), size, {}), {.double_precision = true})};
        PieceCache cache;
        for (const double far : {3.0, 2.5, 2.4, 1.5}) {
            const Placement placement = Placement::b_moves(
                Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, far * size, 0, 0}).value());
            ball.expect_same_answers(placement, &cache);
            ASSERT_FALSE(HasFatalFailure()) << size << ", " << far;
        }
    }
}

// By the table of needs: a file without pieces does not serve questions through them.
TEST(DistanceThroughLawsDeathTest, QuestionsStopWhereAModelWasNotBakedForThem) {
    const OpenModel plain = open_tiny(unit_cube()), cube = open_pieces(unit_cube());
    Workspace workspace;
    const Placement still = Placement::b_moves(Pose());
    EXPECT_DEATH((void)distance({plain.model, cube.model, still, kThroughPieces}, workspace),
                 "pieces needs");
    EXPECT_DEATH((void)within({cube.model, plain.model, still, kThroughPieces}, 1, workspace),
                 "pieces needs");
    EXPECT_DEATH(
        (void)pairs_within({cube.model, plain.model, still, kThroughPieces}, 1, workspace, {}),
        "pieces needs");
    EXPECT_DEATH((void)any_overlap_through({plain.model, plain.model, still}, kPieces, workspace),
                 "pieces needs");
    EXPECT_EQ(distance({plain.model, cube.model, still}, workspace)->upper, 0);
}

// By definition: a model without triangles is far from nothing.
TEST(DistanceThroughLaws, NothingIsFarFromAnEmptyModel) {
    const OpenModel cube = open_pieces(unit_cube());
    const OpenModel empty = open_pieces(TestMesh{});
    Workspace workspace;
    PieceCache cache;
    const Placement still = Placement::b_moves(Pose());
    (void)distance({cube.model, cube.model, still, kThroughPieces, &cache.pair, &cache.front},
                   workspace);
    EXPECT_FALSE(distance(
        {empty.model, cube.model, still, kThroughPieces, &cache.pair, &cache.front}, workspace));
    EXPECT_FALSE(within({cube.model, empty.model, still, kThroughPieces, &cache.pair, &cache.front},
                        1, workspace));
    EXPECT_EQ(pairs_within({cube.model, empty.model, still, kThroughPieces}, 1, workspace, {}), 0U);
    EXPECT_FALSE(any_overlap_through({empty.model, empty.model, still, {}, &cache.pair}, kPieces,
                                     workspace));
}

// On read-only pages, with every section closed that is neither what distance() needs nor named
// by the table of needs.
TEST(DistanceThroughLaws, PiecesReadOnlyTheSectionsThatTheyName) {
    const TestMesh mesh = icosphere(3);
    const AlignedBytes file = on_pages(with_piece_tree(bake_tiny(mesh.positions, mesh.triangles)));
    const OpenModel whole = open_tiny(AlignedBytes(file.span()));
    format::SectionSet wanted = {SectionId::bvh_nodes, SectionId::bvh_leaves,
                                 SectionId::source_triangle, SectionId::positions_f32,
                                 SectionId::triangles};
    wanted.insert(find_needs(ask_of(Structure::pieces))->needed);
    const GuardedPages pages(file.span(), wanted);
    EXPECT_GE(pages.guarded(), 3);
    const auto opened = Model::open(pages.bytes(), wanted);
    ASSERT_TRUE(opened) << opened.error().message;
    const Model& model = opened.value();
    Workspace workspace;
    PieceCache cache;
    std::mt19937 random(5);
    std::size_t apart = 0;
    for (int i = 0; i < 40; ++i) {
        const Placement placement = Placement::b_moves(random_pose(random, 2));
        const auto truth = distance({whole.model, whole.model, placement}, workspace);
        for (PieceCache* from : {static_cast<PieceCache*>(nullptr), &cache}) {
            expect_alike(truth, distance({model, model, placement, kThroughPieces,
                                          from == nullptr ? nullptr : &from->pair,
                                          from == nullptr ? nullptr : &from->front},
                                         workspace));
            ASSERT_FALSE(HasFatalFailure());
            EXPECT_TRUE(within(
                {model, model, placement, kThroughPieces, from == nullptr ? nullptr : &from->pair,
                 from == nullptr ? nullptr : &from->front},
                truth->upper, workspace));
        }
        apart += truth->lower > 0 ? 1 : 0;
    }
    EXPECT_GT(apart, 12U);
    EXPECT_LT(apart, 28U);
}

}  // namespace
}  // namespace cdprep::test
