// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "cdprep/pairs.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

using build::BvhBounds;

constexpr std::array<BvhBounds, 6> kAll = {
    BvhBounds::aligned,     BvhBounds::oriented,         BvhBounds::swept_points,
    BvhBounds::swept_lines, BvhBounds::swept_rectangles, BvhBounds::oriented_and_swept};

/// Everything that is asked of one pair of models.
struct Answers {
    std::vector<TrianglePair> pairs;
    bool hit;
    double lower, upper;
    std::uint32_t triangle_a, triangle_b;  ///< the nearest, where they do not touch
    bool within_nearer, within_farther;
    friend bool operator==(const Answers&, const Answers&) = default;
};

Answers answers_of(const Model& a, const Model& b, const Placement& placement) {
    Workspace workspace;
    Answers found{};
    found.pairs = all_pairs(a, b, placement, workspace);
    found.hit = collide({a, b, placement}, workspace).hit == Answer::yes;
    const Distance d = distance({a, b, placement}, workspace).value();
    found.lower = d.lower;
    found.upper = d.upper;
    if (!found.hit) {  // of many contacts any may be named
        found.triangle_a = d.triangle_a;
        found.triangle_b = d.triangle_b;
    }
    found.within_nearer = within({a, b, placement}, 0.99 * d.lower, workspace);
    found.within_farther = within({a, b, placement}, d.upper, workspace);
    return found;
}

// What a model is bounded with decides how fast an answer comes, never which: pairs by
// brute force, all else against the axis-aligned boxes. Also of models that are not
// bounded alike.
TEST(BoundsLaws, NoAnswerDependsOnTheBounds) {
    constexpr std::uint32_t kSeed = 20261122;
    constexpr int kRounds = 120;
    std::mt19937 random(kSeed);
    int hits = 0;
    for (int round = 0; round < kRounds; ++round) {
        const bool coarse = round % 2 == 0;
        const TestMesh a =
            coarse ? coarse_grid_soup(random(), 70, 3) : random_soup(random(), 90, 0.3);
        const TestMesh b =
            coarse ? coarse_grid_soup(random(), 70, 3) : random_soup(random(), 90, 0.3);
        const double reach = coarse ? 7 : 1.5;
        const Pose p = random_pose(random, reach), q = random_pose(random, reach);
        const Placement placement = round % 3 == 0   ? Placement::world(p, q)
                                    : round % 3 == 1 ? Placement::b_moves(p)
                                                     : Placement::relative(p, q);
        const TinyOptions plain{.double_precision = round % 4 == 0, .bounds = BvhBounds::aligned};
        const OpenModel plain_a = open_tiny(a, plain), plain_b = open_tiny(b, plain);
        const Answers expected = answers_of(plain_a.model, plain_b.model, placement);
        ASSERT_EQ(expected.pairs, brute_force_pairs(a, b, placement)) << kSeed << ", " << round;
        hits += expected.hit ? 1 : 0;
        for (const BvhBounds bounds : kAll) {
            TinyOptions options = plain;
            options.bounds = bounds;
            const OpenModel model_a = open_tiny(a, options);
            for (const BvhBounds other : {bounds, kAll[random() % kAll.size()]}) {
                options.bounds = other;
                const OpenModel model_b = open_tiny(b, options);
                ASSERT_EQ(answers_of(model_a.model, model_b.model, placement), expected)
                    << "seed " << kSeed << ", round " << round << ", bounds "
                    << static_cast<int>(bounds) << " and " << static_cast<int>(other);
            }
        }
    }
    EXPECT_GT(hits, kRounds * 3 / 10);
    EXPECT_LT(hits, kRounds * 7 / 10);
}

// Surfaces that lie close over large parts: what the bounds are for.
TEST(BoundsLaws, ParallelSurfacesGiveTheSamePairsAndGaps) {
    std::mt19937 random(17);
    const TestMesh outer = icosphere(4), ring = torus(1, 0.3, 48, 24);
    int hits = 0;
    for (int round = 0; round < 12; ++round) {
        const double size = 0.9 + 0.1 * (round % 3);
        const Placement placement = Placement::b_moves(random_pose(random, 0.02));
        const TestMesh& a = round % 2 == 0 ? outer : ring;
        const TestMesh b = moved_by(a, size, {});
        TinyOptions options{.double_precision = true, .bounds = BvhBounds::aligned};
        const OpenModel plain_a = open_tiny(a, options), plain_b = open_tiny(b, options);
        const Answers expected = answers_of(plain_a.model, plain_b.model, placement);
        hits += expected.hit ? 1 : 0;
        for (const BvhBounds bounds : kAll) {
            options.bounds = bounds;
            const OpenModel model_a = open_tiny(a, options), model_b = open_tiny(b, options);
            ASSERT_EQ(answers_of(model_a.model, model_b.model, placement), expected)
                << round << ", " << static_cast<int>(bounds);
        }
    }
    EXPECT_GT(hits, 3);
    EXPECT_LT(hits, 12);
}

}  // namespace
}  // namespace cdprep::test
