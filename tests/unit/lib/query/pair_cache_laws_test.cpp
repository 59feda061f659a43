// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "cdprep/pairs.h"
#include "support/open_tiny.h"
#include "support/placements.h"
#include "support/random_pose.h"
#include "support/same_distance.h"
#include "walk/proven_gap.h"

// The truth in all of these is what the same question answers without a cache.

namespace cdprep::test {
namespace {

/// Turned by a small angle about a random axis.
Pose turned_a_little(std::mt19937& random, const Double3& translation) {
    std::normal_distribution<double> normal(0, 0.002);
    return Pose::from_quaternion(1, normal(random), normal(random), normal(random), translation)
        .value();
}

/// Steps of 2^-k from and to the other model, sometimes turned: on a coarse grid many
/// of the places touch exactly.
std::vector<Pose> random_walk(std::mt19937& random, int steps, double reach) {
    const double step = std::ldexp(reach, -static_cast<int>(3 + random() % 4));
    Double3 at = {reach * (static_cast<int>(random() % 9) - 4) / 4, 0, 0};
    Double3 along = {0, 0, 0};
    std::vector<Pose> walk;
    for (int i = 0; i < steps; ++i) {
        if (i % 8 == 0) {
            const auto way = [&] { return step * (static_cast<int>(random() % 3) - 1); };
            along = {way(), way(), way()};
        }
        at = {at.x + along.x, at.y + along.y, at.z + along.z};
        walk.push_back(
            random() % 4 == 0
                ? turned_a_little(random, at)
                : Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, at.x, at.y, at.z}).value());
    }
    return walk;
}

struct Walker {
    const Model& a;
    const Model& b;
    Workspace workspace;
    std::size_t asked = 0;
    std::size_t hits = 0;

    void expect_same_pairs(const Placement& placement, const PairOptions& options,
                           PairCache& cache) {
        std::vector<TrianglePair> plain(10'000), cached(10'000);
        plain.resize(overlaps({a, b, placement, options}, workspace, plain));
        cached.resize(overlaps({a, b, placement, options, &cache}, workspace, cached));
        ASSERT_EQ(plain, cached);
        hits += plain.empty() ? 0 : 1;
        ++asked;
    }

    /// Asks one of all questions with the cache and without.
    void ask(unsigned question, const Placement& placement, PairCache& cache) {
        PairOptions options;
        if (question % 3 == 1) options.overlap = Overlap::proper;
        if (question % 5 == 1) options.degenerate = Degenerate::skip;
        if (question % 7 == 1) options.body = Body::solid;
        switch (question % 6) {
            case 0: {
                expect_same(distance({a, b, placement}, workspace),
                            distance({a, b, placement, {}, &cache}, workspace));
                break;
            }
            case 1: {
                const double tolerance = 0.03125 * (question % 9);
                ASSERT_EQ(within({a, b, placement}, tolerance, workspace),
                          within({a, b, placement, {}, &cache}, tolerance, workspace));
                break;
            }
            case 2:
            case 3: {
                expect_same_pairs(placement, options, cache);
                break;
            }
            default: {
                const Collision plain = collide({a, b, placement, options}, workspace);
                const Collision cached = collide({a, b, placement, options, &cache}, workspace);
                ASSERT_EQ(plain.hit, cached.hit);
                ASSERT_EQ(plain.containment.answer, cached.containment.answer);
                hits += plain.hit == Answer::yes ? 1 : 0;
                ++asked;
            }
        }
    }
};

TEST(PairCacheLaws, NoAnswerChangesOnWalksThroughTouch) {
    constexpr std::uint32_t kSeed = 20261122;
    std::mt19937 random(kSeed);
    std::size_t asked = 0, hits = 0;
    for (int round = 0; round < 60; ++round) {
        const bool coarse = round % 2 == 0;
        const TestMesh mesh_a = coarse ? coarse_grid_soup(random(), 12, 2) : icosphere(2);
        const TestMesh mesh_b = coarse ? coarse_grid_soup(random(), 12, 2) : torus(1, 0.25, 20, 10);
        const OpenModel a = open_tiny(mesh_a, {.double_precision = round % 3 == 0});
        const OpenModel b = open_tiny(mesh_b);
        Walker walker{a.model, b.model, {}};
        PairCache cache, collisions;
        const Pose other = coarse ? Pose() : random_pose(random, 1);
        for (const Pose& pose : random_walk(random, 100, coarse ? 4 : 1)) {
            const Placement placement = placement_of_kind(round / 2, pose, other);
            walker.ask(random(), placement, cache);
            ASSERT_FALSE(HasFatalFailure()) << "seed " << kSeed << ", round " << round;
            walker.ask(2, placement, collisions);
            ASSERT_FALSE(HasFatalFailure()) << "seed " << kSeed << ", round " << round;
        }
        asked += walker.asked;
        hits += walker.hits;
    }
    // Neither answer may be rare, or this test would prove nothing.
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 7 / 10);
}

// A cache of one pair handed to another, on every question: only time is lost.
TEST(PairCacheLaws, ACacheOfOtherModelsIsHarmless) {
    std::mt19937 random(3);
    const OpenModel ball = open_tiny(icosphere(2)), ring = open_tiny(torus(1, 0.25, 20, 10));
    const OpenModel cube = open_tiny(unit_cube()), empty = open_tiny(TestMesh{});
    std::vector<Walker> walkers;
    walkers.push_back({ball.model, ring.model, {}});
    walkers.push_back({ring.model, ball.model, {}});
    walkers.push_back({cube.model, ball.model, {}});
    PairCache cache;
    std::size_t asked = 0, hits = 0;
    for (const Pose& pose : random_walk(random, 400, 1)) {
        const Placement placement = Placement::b_moves(pose);
        Walker& walker = walkers[random() % walkers.size()];
        walker.ask(random(), placement, cache);
        ASSERT_FALSE(HasFatalFailure());
        EXPECT_FALSE(
            collide({empty.model, ball.model, placement, {}, &cache}, walker.workspace).hit ==
            Answer::yes);
        EXPECT_FALSE(
            collide({ball.model, empty.model, placement, {}, &cache}, walker.workspace).hit ==
            Answer::yes);
    }
    for (const Walker& walker : walkers) {
        asked += walker.asked;
        hits += walker.hits;
    }
    EXPECT_GT(hits, asked * 3 / 10);
    EXPECT_LT(hits, asked * 7 / 10);
}

// By the definition of a lower bound: what is left of a gap is never more than the
// distance, however the models have moved since, and is often something.
TEST(PairCacheLaws, WhatIsLeftOfAGapIsNoMoreThanTheDistance) {
    std::mt19937 random(5);
    int proved = 0, asked = 0;
    for (const double size : {0x1p-900, 1e-6, 1.0, 1e6, 0x1p900}) {
        const TestMesh mesh = moved_by(icosphere(2), size, {size / 3, size, -size});
        const OpenModel a = open_tiny(mesh, {.double_precision = true});
        Workspace workspace;
        for (int round = 0; round < 40; ++round) {
            const double share = std::ldexp(1, -static_cast<int>(random() % 30));
            const Pose p = random_pose(random, 4 * size), q = random_pose(random, 4 * size);
            const Double3 from = p.translation();
            const Double3 to = {from.x + share * size, from.y - share * size, from.z};
            const Pose near =
                Pose::from_rows({p.rotation()[0], p.rotation()[1], p.rotation()[2], p.rotation()[3],
                                 p.rotation()[4], p.rotation()[5], p.rotation()[6], p.rotation()[7],
                                 p.rotation()[8], to.x, to.y, to.z})
                    .value();
            PairCache cache;
            const Placement before = placement_of_kind(round, p, q),
                            after = placement_of_kind(round, near, q);
            const auto old = distance({a.model, a.model, before, {}, &cache}, workspace);
            const auto now = distance({a.model, a.model, after}, workspace);
            const double left = proven_gap(cache, a.model, a.model, after);
            ASSERT_LE(left, now->upper) << size << ", round " << round;
            if (old->lower <= 4 * share * size) continue;
            ++asked;
            proved += left > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(asked, 50);
    EXPECT_GT(proved, asked * 9 / 10);
}

}  // namespace
}  // namespace cdprep::test
