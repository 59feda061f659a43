// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cdprep/pairs.h"
#include "exact/exact_within.h"
#include "support/brute_force.h"
#include "support/exact_distance.h"
#include "support/open_tiny.h"
#include "support/placements.h"
#include "support/random_pose.h"
#include "support/rounds.h"

namespace cdprep::test {
namespace {

std::vector<TrianglePair> all_within(const Model& a, const Model& b, const Placement& placement,
                                     double tolerance, Workspace& workspace,
                                     const PairOptions& options = {}) {
    std::vector<TrianglePair> pairs(
        pairs_within({a, b, placement, options}, tolerance, workspace, {}));
    pairs.resize(pairs_within({a, b, placement, options}, tolerance, workspace, pairs));
    return pairs;
}

const int kShare = (asks_all() ? 1 : 3) * kSlowdown;

/// The squares of all distances, in rational numbers, in the order of the pairs.
std::vector<ExactRational> squared_distances(const TestMesh& a, const TestMesh& b,
                                             const Placement& placement) {
    const Pose* pose_a = placement.a_is_moved() ? &placement.pose_a() : nullptr;
    const Pose* pose_b = placement.b_is_moved() ? &placement.pose_b() : nullptr;
    std::vector<ExactRational> squares;
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
        for (std::size_t j = 0; j < b.triangles.size(); ++j) {
            squares.push_back(
                exact_squared_distance(corners_of(a, i, pose_a), corners_of(b, j, pose_b)));
        }
    }
    return squares;
}

std::vector<TrianglePair> brute_force_within(const TestMesh& b,
                                             const std::vector<ExactRational>& squares,
                                             double tolerance) {
    std::vector<TrianglePair> pairs;
    const ExactRational limit = exact_square(tolerance);
    for (std::size_t i = 0; i < squares.size(); ++i) {
        const auto of_b = static_cast<std::uint32_t>(b.triangles.size());
        const auto at = static_cast<std::uint32_t>(i);
        if (squares[i] <= limit) pairs.push_back({at / of_b, at % of_b});
    }
    return pairs;
}

Placement random_placement(std::mt19937& random, double reach) {
    const Pose p = random_pose(random, reach), q = random_pose(random, reach);
    return placement_of_kind(random(), p, q);
}

build::BvhBounds bounds_of(int round) {
    return static_cast<build::BvhBounds>(round % 6);
}

// The oracle: squares in rational numbers. The tolerance is one of the distances, up to
// the last bit, so that half of all pairs are within it and one is next to it.
TEST(TrianglesWithinLaws, AgreesWithRationalsOnFineNumbers) {
    constexpr std::uint32_t kSeed = 71;
    std::mt19937 random(kSeed);
    std::size_t within = 0, asked = 0;
    for (int round = 0; round < 60 / kShare; ++round) {
        const TestMesh a = random_soup(random(), 12, 0.2), b = random_soup(random(), 12, 0.2);
        const OpenModel model_a =
            open_tiny(a, {.double_precision = round % 3 == 0, .bounds = bounds_of(round)});
        const OpenModel model_b = open_tiny(b, {.bounds = bounds_of(round)});
        Workspace workspace;
        const Placement placement = random_placement(random, round % 5 == 0 ? 10 : 0.5);
        const auto squares = squared_distances(a, b, placement);
        for (int i = 0; i < 4; ++i) {
            const ExactRational& chosen = squares[random() % squares.size()];
            double tolerance = static_cast<double>(std::sqrt(chosen.approximation()));
            if (i % 2 == 0) tolerance = std::nextafter(tolerance, 0.0);
            const auto expected = brute_force_within(b, squares, tolerance);
            ASSERT_EQ(all_within(model_a.model, model_b.model, placement, tolerance, workspace),
                      expected)
                << "seed " << kSeed << ", round " << round << ", tolerance " << tolerance;
            within += expected.size();
            asked += squares.size();
        }
    }
    EXPECT_GT(within, asked * 3 / 10);
    EXPECT_LT(within, asked * 7 / 10);
}

/// A quarter turn and a step along the grid: integers stay integers.
Placement grid_placement(std::mt19937& random) {
    const auto step = [&random] { return static_cast<double>(random() % 9) - 4; };
    return Placement::b_moves(
        Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, step(), step(), step()}).value());
}

// The oracle: the same, on a grid, where whole distances are met often, triangles touch
// and degenerate ones are common; one step less must leave out what is met.
TEST(TrianglesWithinLaws, AgreesWithRationalsOnACoarseGrid) {
    constexpr std::uint32_t kSeed = 72;
    std::mt19937 random(kSeed);
    std::size_t within = 0, asked = 0, ties = 0;
    for (int round = 0; round < 300 / kShare; ++round) {
        const TestMesh a = coarse_grid_soup(random(), 10, 2), b = coarse_grid_soup(random(), 10, 2);
        const OpenModel model_a =
            open_tiny(a, {.double_precision = round % 3 == 0, .bounds = bounds_of(round)});
        const OpenModel model_b = open_tiny(b, {.bounds = bounds_of(round)});
        Workspace workspace;
        const Placement placement = grid_placement(random);
        const auto squares = squared_distances(a, b, placement);
        const auto tolerance = static_cast<double>(1 + random() % 5);
        std::size_t found = 0;
        for (const double at : {tolerance, std::nextafter(tolerance, 0.0)}) {
            const auto expected = brute_force_within(b, squares, at);
            ASSERT_EQ(all_within(model_a.model, model_b.model, placement, at, workspace), expected)
                << "seed " << kSeed << ", round " << round << ", tolerance " << at;
            within += expected.size();
            asked += squares.size();
            ties += at == tolerance ? expected.size() : 0;
            found = expected.size();
        }
        ties -= found;
    }
    EXPECT_GT(ties, 200 / static_cast<std::size_t>(kShare));
    EXPECT_GT(within, asked * 3 / 10);
    EXPECT_LT(within, asked * 7 / 10);
}

// The oracle: the exact question about two triangles, which rational numbers prove, of
// all of them. Here there are levels to walk and batches to fill.
TEST(TrianglesWithinLaws, AgreesWithAllPairsAskedOneByOne) {
    constexpr std::uint32_t kSeed = 76;
    std::mt19937 random(kSeed);
    const TestMesh a = in_floats(icosphere(2)), b = in_floats(torus(1, 0.25, 20, 10));
    std::size_t within = 0, asked = 0;
    for (int round = 0; round < 20 / kShare; ++round) {
        const OpenModel model_a = open_tiny(a, {.bounds = bounds_of(round)});
        const OpenModel model_b = open_tiny(b, {.bounds = bounds_of(round)});
        Workspace workspace;
        const Placement placement = random_placement(random, round % 2 == 0 ? 0.25 : 1);
        const Pose* pose_a = placement.a_is_moved() ? &placement.pose_a() : nullptr;
        const Pose* pose_b = placement.b_is_moved() ? &placement.pose_b() : nullptr;
        for (const double tolerance : {0.01, 0.1, 1.0, 1.75, 2.25}) {
            std::vector<TrianglePair> expected;
            for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
                const Corners at_a = corners_of(a, i, pose_a);
                for (std::uint32_t j = 0; j < b.triangles.size(); ++j) {
                    if (is_within_exactly(at_a, corners_of(b, j, pose_b), tolerance)) {
                        expected.push_back({i, j});
                    }
                }
            }
            ASSERT_EQ(all_within(model_a.model, model_b.model, placement, tolerance, workspace),
                      expected)
                << "seed " << kSeed << ", round " << round << ", tolerance " << tolerance;
            within += expected.size();
            asked += a.triangles.size() * b.triangles.size();
        }
    }
    EXPECT_GT(within, asked * 3 / 10);
    EXPECT_LT(within, asked * 7 / 10);
}

// Laws of larger meshes: 0 is overlap, more tolerance is more pairs, the nearest pair is
// the first to come in, one by one is all at once, swapped models have swapped pairs.
TEST(TrianglesWithinLaws, EveryFormGivesTheSameSet) {
    std::mt19937 random(73);
    const OpenModel a = open_tiny(icosphere(3), {.double_precision = true});
    const OpenModel b = open_tiny(torus(1, 0.25, 24, 12));
    Workspace workspace;
    std::size_t total = 0;
    for (int round = 0; round < 20; ++round) {
        const Pose pose = random_pose(random, round % 2 == 0 ? 0.5 : 3);
        const Placement placement = Placement::b_moves(pose);
        const auto apart = distance({a.model, b.model, placement}, workspace);
        std::vector<TrianglePair> before =
            all_pairs(a.model, b.model, placement, workspace, {.degenerate = Degenerate::keep});
        EXPECT_EQ(all_within(a.model, b.model, placement, 0, workspace), before);
        EXPECT_EQ(all_within(a.model, b.model, placement, 0x1p-1000, workspace), before);
        for (const double more : {0.0, 0.01, 0.1}) {
            const double tolerance = apart->upper + more;
            const auto pairs = all_within(a.model, b.model, placement, tolerance, workspace);
            EXPECT_TRUE(std::includes(pairs.begin(), pairs.end(), before.begin(), before.end()));
            EXPECT_TRUE(std::binary_search(pairs.begin(), pairs.end(),
                                           TrianglePair{apart->triangle_a, apart->triangle_b}));
            std::vector<TrianglePair> visited;
            const auto visit = [&](const TrianglePair& pair) {
                visited.push_back(pair);
                return true;
            };
            EXPECT_TRUE(
                visit_pairs_within({a.model, b.model, placement}, tolerance, workspace, visit));
            std::sort(visited.begin(), visited.end());
            ASSERT_EQ(visited, pairs);
            auto swapped =
                all_within(b.model, a.model, Placement::a_moves(pose), tolerance, workspace);
            for (TrianglePair& pair : swapped) std::swap(pair.a, pair.b);
            std::sort(swapped.begin(), swapped.end());
            ASSERT_EQ(swapped, pairs);
            std::size_t seen = 0;
            const auto stop_early = [&](const TrianglePair&) { return ++seen < 5; };
            EXPECT_EQ(
                visit_pairs_within({a.model, b.model, placement}, tolerance, workspace, stop_early),
                pairs.size() < 5);
            EXPECT_EQ(seen, std::min<std::size_t>(5, pairs.size()));
            total += pairs.size();
            before = pairs;
        }
    }
    EXPECT_GT(total, 10'000U);
}

// By the definition: the pairs that neither side's bits of degenerate triangles name.
TEST(TrianglesWithinLaws, SkippingLeavesOutDegenerateTriangles) {
    std::mt19937 random(74);
    std::size_t skipped = 0, kept = 0;
    for (int round = 0; round < 60; ++round) {
        TestMesh mesh = coarse_grid_soup(random(), 40, 1);
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 5) {
            mesh.triangles[i].vertex[2] = mesh.triangles[i].vertex[i % 2];
        }
        const OpenModel model = open_tiny(mesh);
        Workspace workspace;
        const Placement placement = grid_placement(random);
        for (const double tolerance : {0.0, 1.0, 3.0, 99.0}) {
            std::vector<TrianglePair> expected;
            for (const TrianglePair& pair :
                 all_within(model.model, model.model, placement, tolerance, workspace)) {
                const bool skip = is_degenerate(corners_of(mesh, pair.a, nullptr)) ||
                                  is_degenerate(corners_of(mesh, pair.b, nullptr));
                if (!skip) expected.push_back(pair);
                ++(skip ? skipped : kept);
            }
            ASSERT_EQ(all_within(model.model, model.model, placement, tolerance, workspace,
                                 {.degenerate = Degenerate::skip}),
                      expected);
        }
    }
    EXPECT_GT(kept, (kept + skipped) * 3 / 10);
    EXPECT_LT(kept, (kept + skipped) * 7 / 10);
}

// within() asks whether there is any.
TEST(TrianglesWithinLaws, AgreesWithWithin) {
    std::mt19937 random(75);
    int hits = 0;
    constexpr int kRounds = 400;
    for (int round = 0; round < kRounds; ++round) {
        const bool coarse = round % 2 == 0;
        const auto soup = [&] {
            return coarse ? coarse_grid_soup(random(), 8, 1) : random_soup(random(), 8, 0.2);
        };
        const TestMesh mesh_a = soup(), mesh_b = soup();
        const OpenModel a = open_tiny(mesh_a), b = open_tiny(mesh_b);
        Workspace workspace;
        const Placement placement = coarse ? grid_placement(random) : random_placement(random, 1);
        const double tolerance = coarse ? 1 : 0.25;
        const bool any = pairs_within({a.model, b.model, placement}, tolerance, workspace, {}) > 0;
        ASSERT_EQ(any, within({a.model, b.model, placement}, tolerance, workspace)) << round;
        hits += any ? 1 : 0;
    }
    EXPECT_GT(hits, kRounds * 3 / 10);
    EXPECT_LT(hits, kRounds * 7 / 10);
}

}  // namespace
}  // namespace cdprep::test
