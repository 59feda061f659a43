// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>

#include "cdprep/pairs.h"
#include "support/brute_force.h"
#include "support/exact_contact.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

// The oracle: brute force by the six-segment test. Fine and coarse meshes, poses
// that move B, A, both by their own pose, and both relatively.
TEST(OverlappingTrianglesLaws, AgreesWithBruteForce) {
    constexpr std::uint32_t kSeed = 20261121;
    constexpr int kRounds = 60;
    std::mt19937 random(kSeed);
    std::size_t touching = 0, asked = 0;
    for (int round = 0; round < kRounds; ++round) {
        const bool coarse = round % 2 == 0;
        const TestMesh a =
            coarse ? coarse_grid_soup(random(), 60, 3) : random_soup(random(), 80, 0.2);
        const TestMesh b =
            coarse ? coarse_grid_soup(random(), 60, 3) : random_soup(random(), 80, 0.2);
        const OpenModel model_a = open_tiny(a, {.double_precision = round % 3 == 0});
        const OpenModel model_b = open_tiny(b);
        Workspace workspace;
        const Pose p = round % 4 == 0 ? Pose() : random_pose(random, 1);
        const Pose q = random_pose(random, 1);
        for (const Placement& placement :
             {Placement::b_moves(p), Placement::a_moves(p), Placement::relative(p, q),
              Placement::world(p, q), Placement::world(q, q)}) {
            const auto pairs = all_pairs(model_a.model, model_b.model, placement, workspace);
            ASSERT_EQ(pairs, brute_force_pairs(a, b, placement))
                << "seed " << kSeed << ", round " << round;
            const bool hit =
                collide({model_a.model, model_b.model, placement}, workspace).hit == Answer::yes;
            ASSERT_EQ(hit, !pairs.empty());
            touching += pairs.size();
            asked += a.triangles.size() * b.triangles.size();
        }
    }
    // Neither answer may be rare, or this test would prove nothing.
    EXPECT_GT(touching, asked / 200);
    EXPECT_LT(touching, asked / 2);
}

/// A rotation of the cube and a step along the grid: integers stay integers.
Pose grid_pose(std::mt19937& random, int reach) {
    std::array<int, 3> axes = {0, 1, 2};
    std::shuffle(axes.begin(), axes.end(), random);
    std::array<double, 12> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
        rows[3 * i + static_cast<std::size_t>(axes[i])] = random() % 2 == 0 ? 1 : -1;
        rows[9 + i] =
            static_cast<double>(random() % (2 * static_cast<unsigned>(reach) + 1)) - reach;
    }
    if (auto pose = Pose::from_rows(rows)) return pose.value();
    for (std::size_t i = 0; i < 3; ++i) rows[i] = -rows[i];  // it mirrored
    return Pose::from_rows(rows).value();
}

/// By the definition, in machine integers, which small grids never leave.
std::vector<TrianglePair> integer_pairs(const TestMesh& a, const TestMesh& b,
                                        const Placement& placement) {
    return boxed_pairs(a, b, placement, [](const Corners& s, const Corners& t) {
        return contact_by_definition(exact<std::int64_t>(s), exact<std::int64_t>(t)) !=
               TriangleContact::disjoint;
    });
}

// The oracle: the definition of contact, on grids where most coincidences there are
// come about. B moves; then A moves by the same pose with the roles exchanged.
TEST(OverlappingTrianglesLaws, TenThousandPairsOfCoarseMeshesAreExact) {
    constexpr std::uint32_t kSeed = 10000;
    constexpr int kRounds = 10'000;
    std::mt19937 random(kSeed);
    int hits = 0;
    std::size_t pairs_found = 0;
    Workspace workspace;
    for (int round = 0; round < kRounds; ++round) {
        const TestMesh a = coarse_grid_soup(random(), 6 + round % 9, 2);
        const TestMesh b = coarse_grid_soup(random(), 6 + round % 7, 2);
        const OpenModel model_a = open_tiny(a, {.double_precision = round % 3 == 0});
        const OpenModel model_b = open_tiny(b);
        const Pose pose = grid_pose(random, 4);
        const Placement placement = Placement::b_moves(pose);
        const auto expected = integer_pairs(a, b, placement);
        ASSERT_EQ(all_pairs(model_a.model, model_b.model, placement, workspace), expected)
            << "seed " << kSeed << ", round " << round;
        auto swapped = all_pairs(model_b.model, model_a.model, Placement::a_moves(pose), workspace);
        for (TrianglePair& pair : swapped) std::swap(pair.a, pair.b);
        std::sort(swapped.begin(), swapped.end());
        ASSERT_EQ(swapped, expected) << "seed " << kSeed << ", round " << round;
        hits += expected.empty() ? 0 : 1;
        pairs_found += expected.size();
    }
    EXPECT_GT(hits, kRounds * 3 / 10);
    EXPECT_LT(hits, kRounds * 7 / 10);
    EXPECT_GT(pairs_found, 20'000U);
}

// Pairs one by one, and the two sets alone, say the same as the sorted pairs.
TEST(OverlappingTrianglesLaws, EveryFormGivesTheSameSet) {
    std::mt19937 random(13);
    const TestMesh a = icosphere(3), b = torus(1, 0.25, 24, 12);
    const OpenModel model_a = open_tiny(a, {.double_precision = true});
    const OpenModel model_b = open_tiny(b, {.double_precision = true});
    Workspace workspace;
    std::vector<std::uint64_t> bits_a(a.triangles.size() / 64 + 1, ~std::uint64_t{0});
    std::vector<std::uint64_t> bits_b(b.triangles.size() / 64 + 1, ~std::uint64_t{0});
    std::size_t total = 0;
    for (int round = 0; round < 30; ++round) {
        const Placement placement = Placement::b_moves(random_pose(random, 0.5));
        const auto pairs = all_pairs(model_a.model, model_b.model, placement, workspace);
        std::vector<TrianglePair> visited;
        const auto visit = [&](const TrianglePair& pair) {
            visited.push_back(pair);
            return true;
        };
        EXPECT_TRUE(visit_overlaps({model_a.model, model_b.model, placement}, workspace, visit));
        std::sort(visited.begin(), visited.end());
        ASSERT_EQ(visited, pairs);

        std::vector<std::uint64_t> expected_a(bits_a.size()), expected_b(bits_b.size());
        for (const TrianglePair& pair : pairs) {
            expected_a[pair.a / 64] |= std::uint64_t{1} << (pair.a % 64);
            expected_b[pair.b / 64] |= std::uint64_t{1} << (pair.b % 64);
        }
        ASSERT_EQ(
            mark_overlaps({model_a.model, model_b.model, placement}, workspace, bits_a, bits_b),
            pairs.size());
        ASSERT_EQ(bits_a, expected_a);
        ASSERT_EQ(bits_b, expected_b);
        total += pairs.size();

        std::size_t seen = 0;
        const auto stop_early = [&](const TrianglePair&) { return ++seen < 5; };
        EXPECT_EQ(visit_overlaps({model_a.model, model_b.model, placement}, workspace, stop_early),
                  pairs.size() < 5);
        EXPECT_EQ(seen, std::min<std::size_t>(5, pairs.size()));
    }
    EXPECT_GT(total, 1000u);
    std::span<std::uint64_t> nothing;
    const Placement still = Placement::b_moves(Pose());
    EXPECT_EQ(mark_overlaps({model_a.model, model_b.model, still}, workspace, nothing, bits_b),
              all_pairs(model_a.model, model_b.model, still, workspace).size());
}

TEST(OverlappingTrianglesLaws, SwappingTheModelsSwapsThePairs) {
    std::mt19937 random(7);
    const TestMesh a = icosphere(2), b = torus(1, 0.25, 20, 10);
    const OpenModel model_a = open_tiny(a, {.double_precision = true});
    const OpenModel model_b = open_tiny(b, {.double_precision = true});
    Workspace workspace;
    std::size_t total = 0;
    for (int round = 0; round < 50; ++round) {
        const Pose pose = random_pose(random, 0.5);
        auto pairs = all_pairs(model_a.model, model_b.model, Placement::b_moves(pose), workspace);
        auto swapped = all_pairs(model_b.model, model_a.model, Placement::a_moves(pose), workspace);
        for (TrianglePair& pair : swapped) std::swap(pair.a, pair.b);
        std::sort(swapped.begin(), swapped.end());
        ASSERT_EQ(pairs, swapped) << "round " << round;
        total += pairs.size();
    }
    EXPECT_GT(total, 1000u);
}

// Parts of one turned assembly keep their shared vertices: by construction every
// triangle touches itself and its neighbours, however both are turned.
TEST(OverlappingTrianglesLaws, WorldPlacementKeepsSharedVerticesShared) {
    std::mt19937 random(11);
    const OpenModel sphere = open_tiny(icosphere(3), {.double_precision = true});
    Workspace workspace;
    const auto still = all_pairs(sphere.model, sphere.model, Placement::b_moves(Pose()), workspace);
    for (int round = 0; round < 20; ++round) {
        const Pose pose = random_pose(random, 1000);
        ASSERT_EQ(all_pairs(sphere.model, sphere.model, Placement::world(pose, pose), workspace),
                  still)
            << "round " << round;
    }
}

// B15: triangles in another order give the same pairs under their new numbers.
TEST(OverlappingTrianglesLaws, OrderOfTrianglesDoesNotMatter) {
    std::mt19937 random(13);
    const TestMesh a = icosphere(2);
    const OpenModel still = open_tiny(torus(1, 0.5, 16, 8));
    Workspace workspace;
    const Placement placement = Placement::b_moves(random_pose(random, 0.25));
    const auto expected = all_pairs(open_tiny(a).model, still.model, placement, workspace);
    std::vector<std::uint32_t> order(a.triangles.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    TestMesh shuffled{a.positions, {}};
    for (const std::uint32_t source : order) shuffled.triangles.push_back(a.triangles[source]);
    auto pairs = all_pairs(open_tiny(shuffled).model, still.model, placement, workspace);
    for (TrianglePair& pair : pairs) pair.a = order[pair.a];
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(pairs, expected);
    EXPECT_FALSE(pairs.empty());
}

}  // namespace
}  // namespace cdprep::test
