// SPDX-License-Identifier: MIT
#include "cdprep/advanced/closest_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/exact_hull_pair.h"
#include "support/expect_distance.h"
#include "support/hull_pairs.h"
#include "support/rounds.h"
#include "unit/tools/feature_hull_of.h"

namespace cdprep::test {
namespace {

FeatureCache nonsense_features(std::mt19937& random) {
    const auto kind = [&] { return static_cast<FeatureKind>(random() % 3); };
    const auto edge = [&] { return static_cast<std::uint32_t>(random() % 40); };
    return {random() % 4 != 0, {kind(), kind()}, {edge(), edge()}};
}

struct Seen {
    int apart = 0, parallel = 0;
    std::array<int, 9> kinds{};

    void count(const ClosestFeatures& found) {
        ++apart;
        parallel += found.parallel ? 1 : 0;
        ++kinds[3 * static_cast<std::size_t>(found.a.kind) +
                static_cast<std::size_t>(found.b.kind)];
    }
};

/// The bounds hold the truth, and so does what the features by themselves are apart: `exactly`
/// that, or up to rounding.
template <class Number>
void check(const SurfaceHull& a, const SurfaceHull& b, const Pose& pose,
           const std::optional<SquaredLength<Number>>& truth,
           const std::optional<ClosestFeatures>& found, bool exactly) {
    constexpr double kReach = 14;  // of A - B at most
    ASSERT_EQ(found.has_value(), truth.has_value());
    if (!found) return;
    expect_distance(*found, *truth);
    if (testing::Test::HasFatalFailure()) return;
    const Points at_b = moved_points(b.corners(found->b), pose);
    const auto between = ExactHullPair<Number>(a.corners(found->a), at_b).squared_distance();
    ASSERT_TRUE(between);
    if (exactly) {
        ASSERT_FALSE(less(*truth, *between)) << "other features are nearer";
    } else {
        ASSERT_GE(compare_length(found->upper + 1e-14 * kReach, *between), 0)
            << "other features are nearer";
    }
}

// By the definition, in integers: pairs of hulls of dimensions 0 to 3, cold, from where the last
// question ended, and from nonsense.
TEST(ClosestFeatures, GridHullsAnswerTheNearestFeatures) {
    const int pairs = rounds(100'000, 5);
    std::mt19937 random(20240801);
    Seen seen;
    for (int i = 0; i < pairs; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = grid_pair(random);
        const auto truth = ExactHullPair<Integer128>(pair.a, pair.placed).squared_distance();
        const SurfaceHull a(pair.a), b(pair.b);
        const Placement placement = Placement::b_moves(pair.pose);
        FeatureCache cache = nonsense_features(random);
        for (FeatureCache* used : {static_cast<FeatureCache*>(nullptr), &cache, &cache}) {
            const auto found = closest_features(a.view(), b.view(), placement, used);
            check<Integer128>(a, b, pair.pose, truth, found, true);
            if (HasFatalFailure()) return;
            if (found) seen.count(*found);
        }
    }
    EXPECT_GT(seen.apart, 3 * pairs * 3 / 10);
    EXPECT_LT(seen.apart, 3 * pairs * 7 / 10);
    EXPECT_GT(seen.parallel, seen.apart / 50);
    for (const int kind : seen.kinds) EXPECT_GT(kind, 0);
}

// By the definition, in exact numbers; half of the pairs are within some 1e-16 of touching, and
// needles and plates among them.
TEST(ClosestFeatures, FineAndThinHullsAnswerTheNearestFeatures) {
    constexpr int kPairs = 800;
    std::mt19937 random(20240802);
    Seen seen;
    for (int i = 0; i < kPairs; ++i) {
        SCOPED_TRACE(i);
        const HullPair pair = i % 2 == 0 ? fine_pair(random) : thin_pair(random);
        const auto truth = ExactHullPair<ExactNumber>(pair.a, pair.placed).squared_distance();
        const SurfaceHull a(pair.a), b(pair.b);
        const Placement placement = Placement::b_moves(pair.pose);
        FeatureCache cache = nonsense_features(random);
        for (int k = 0; k < 2; ++k) {
            const auto found = closest_features(a.view(), b.view(), placement, &cache);
            check<ExactNumber>(a, b, pair.pose, truth, found, false);
            if (HasFatalFailure()) return;
            if (found && k == 0) seen.count(*found);
        }
    }
    EXPECT_GT(seen.apart, kPairs * 3 / 10);
    EXPECT_LT(seen.apart, kPairs * 7 / 10);
}

// By what must not matter: where a cache begins, in walks past each other, and whether edges are
// climbed. Most steps of a walk are answered by the march alone.
TEST(ClosestFeatures, WalksAnswerAsColdQuestions) {
    std::mt19937 random(20240803);
    int steps = 0, apart = 0, marched = 0;
    for (int walk = 0; walk < 60; ++walk) {
        const bool coarse = walk % 2 == 0;
        const double radius = coarse ? 8 : 1;
        const SurfaceHull a(ball_points(random, 300, coarse));
        const SurfaceHull b(ball_points(random, 200, coarse));
        FeatureCache cache;
        for (int i = 0; i < 60; ++i, ++steps) {
            SCOPED_TRACE(steps);
            const Pose pose =
                Pose::from_quaternion(1, 0.01 * i, 0.02 * i, -0.005 * walk,
                                      {radius * (2.6 - 0.03 * i), radius * (0.02 * i - 0.5), 0.1})
                    .value();
            const Placement placement = Placement::b_moves(pose);
            QueryCounts counts;
            const auto warm =
                closest_features(a.view(i % 2 == 0), b.view(true), placement, &cache, &counts);
            const auto cold = closest_features(a.view(), b.view(), placement);
            ASSERT_EQ(warm.has_value(), cold.has_value());
            if (!warm) continue;
            ++apart;
            marched += counts.hull_steps == 0 ? 1 : 0;
            ASSERT_LE(warm->lower, cold->upper);
            ASSERT_LE(cold->lower, warm->upper);
            ASSERT_LE(warm->upper - warm->lower, 1e-12 * warm->upper + 1e-14 * 4 * radius);
        }
    }
    EXPECT_GT(apart, steps * 3 / 10);
    EXPECT_LT(apart, steps * 9 / 10);
    EXPECT_GT(marched, apart * 3 / 4);
}

// By hand: what is parallel, and what is not.
TEST(ClosestFeatures, ParallelFacesAndEdgesAreSaidToBe) {
    const SurfaceHull box(box_corners(1, 1, 1));
    const auto ask = [&](const std::array<double, 12>& rows) {
        return closest_features(box.view(), box.view(),
                                Placement::b_moves(Pose::from_rows(rows).value()));
    };
    const auto faces = ask({1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0.25, 3});
    ASSERT_TRUE(faces);
    EXPECT_TRUE(faces->parallel);
    EXPECT_NEAR(faces->upper, 1, 1e-14);
    const auto edges = ask({1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 3, 3});
    ASSERT_TRUE(edges);
    EXPECT_TRUE(edges->parallel);
    EXPECT_NEAR(edges->upper, std::sqrt(2), 1e-14);
    const auto corners = ask({1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 3, 3});
    ASSERT_TRUE(corners);
    EXPECT_FALSE(corners->parallel);
    EXPECT_EQ(corners->a.kind, FeatureKind::vertex);
    EXPECT_EQ(corners->b.kind, FeatureKind::vertex);
    // Turned by 3-4-5 about z: an edge stands over a face.
    const auto edge = ask({1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 3});
    ASSERT_TRUE(edge);
    EXPECT_TRUE(edge->parallel);
    EXPECT_NEAR(edge->upper, 3 - 1.4 - 1, 1e-14);
}

TEST(ClosestFeatures, OfNothingThereAreNone) {
    const SurfaceHull box(box_corners(1, 1, 1));
    EXPECT_FALSE(closest_features(box.view(), FeatureHull{}, Placement::b_moves(Pose())));
    EXPECT_FALSE(closest_features(box.view(), box.view(), Placement::b_moves(Pose())));
}

}  // namespace
}  // namespace cdprep::test
