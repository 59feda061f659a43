// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>

#include "cdprep/parallel.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/run_threads.h"

// The truth in all of these is the same question asked alone.

namespace cdprep::test {
namespace {

/// Three models, and jobs of all their pairs.
struct Jobs {
    OpenModel ball = open_tiny(icosphere(2));
    OpenModel ring = open_tiny(torus(1, 0.25, 20, 10));
    OpenModel soup = open_tiny(coarse_grid_soup(1, 40, 1));
    std::vector<Pair> jobs;

    explicit Jobs(int count, const PairOptions& options = {}) {
        std::mt19937 random(1);
        const std::array<const Model*, 3> models = {&ball.model, &ring.model, &soup.model};
        for (int i = 0; i < count; ++i) {
            const Pose p = random_pose(random, 2), q = random_pose(random, 2);
            const Model &a = *models[random() % 3], &b = *models[random() % 3];
            jobs.emplace_back(a, b, i % 2 == 0 ? Placement::b_moves(p) : Placement::world(p, q),
                              options);
        }
    }
};

class Batch : public testing::TestWithParam<std::size_t> {};

TEST_P(Batch, CollideAndWithinAnswerAsAlone) {
    Jobs made(300, {.body = Body::solid});
    std::vector<Workspace> workspaces(GetParam());
    Workspace workspace;
    std::vector<PairCache> caches(made.jobs.size());
    for (std::size_t i = 0; i < made.jobs.size(); i += 2) made.jobs[i].cache = &caches[i];
    std::size_t hits = 0;
    for (int again = 0; again < 2; ++again) {
        std::vector<Collision> collisions(made.jobs.size());
        const auto near = std::make_unique<bool[]>(made.jobs.size());
        collide_many(made.jobs, workspaces, run_threads, collisions);
        within_many(made.jobs, 0.5, workspaces, run_threads,
                    std::span(near.get(), made.jobs.size()));
        hits = 0;
        for (std::size_t i = 0; i < made.jobs.size(); ++i) {
            const Pair& job = made.jobs[i];
            const Collision alone =
                collide({job.a, job.b, job.placement, {.body = Body::solid}}, workspace);
            ASSERT_EQ(collisions[i].hit, alone.hit) << i;
            ASSERT_EQ(collisions[i].containment.answer, alone.containment.answer) << i;
            ASSERT_EQ(near[i], within({job.a, job.b, job.placement}, 0.5, workspace)) << i;
            hits += alone.hit == Answer::yes ? 1 : 0;
        }
    }
    EXPECT_GT(hits, made.jobs.size() * 3 / 10);
    EXPECT_LT(hits, made.jobs.size() * 7 / 10);
}

TEST_P(Batch, DistanceAnswersAsAlone) {
    const Jobs made(200);
    std::vector<Workspace> workspaces(GetParam());
    Workspace workspace;
    std::vector<std::optional<Distance>> answers(made.jobs.size());
    distance_many(made.jobs, workspaces, run_threads, answers, {.max_distance = 1});
    std::size_t none = 0;
    for (std::size_t i = 0; i < made.jobs.size(); ++i) {
        const Pair& job = made.jobs[i];
        const auto alone = distance({job.a, job.b, job.placement}, workspace, {.max_distance = 1});
        ASSERT_EQ(answers[i].has_value(), alone.has_value()) << i;
        none += alone ? 0 : 1;
        if (!alone) continue;
        ASSERT_EQ(answers[i]->lower, alone->lower) << i;
        ASSERT_EQ(answers[i]->upper, alone->upper) << i;
        ASSERT_EQ(answers[i]->triangle_b, alone->triangle_b) << i;
    }
    EXPECT_GT(none, 10u);
    EXPECT_LT(none, 190u);
}

TEST_P(Batch, OverlapsAnswerAsAlone) {
    const Jobs made(100);
    std::vector<Workspace> workspaces(GetParam());
    Workspace workspace;
    constexpr std::size_t kRoom = 50;  // too short for some
    std::vector<TrianglePair> room(made.jobs.size() * kRoom);
    std::vector<std::uint64_t> bits(made.jobs.size() * 20);
    std::vector<OverlapList> answers(made.jobs.size());
    std::vector<OverlapMarks> marked(made.jobs.size());
    std::vector<std::size_t> counts(made.jobs.size());
    for (std::size_t i = 0; i < made.jobs.size(); ++i) {
        answers[i].room = std::span(room).subspan(i * kRoom, kRoom);
        marked[i].bits_a = std::span(bits).subspan(i * 20, 10);
        marked[i].bits_b = std::span(bits).subspan(i * 20 + 10, 10);
    }
    overlaps_many(made.jobs, workspaces, run_threads, answers);
    mark_overlaps_many(made.jobs, workspaces, run_threads, marked);
    count_overlaps_many(made.jobs, workspaces, run_threads, counts);
    std::size_t too_short = 0;
    for (std::size_t i = 0; i < made.jobs.size(); ++i) {
        const Pair& job = made.jobs[i];
        const auto alone = all_pairs(job.a, job.b, job.placement, workspace);
        ASSERT_EQ(answers[i].count, alone.size()) << i;
        ASSERT_EQ(counts[i], alone.size()) << i;
        ASSERT_EQ(marked[i].count, alone.size()) << i;
        const std::size_t kept = std::min(kRoom, alone.size());
        ASSERT_TRUE(std::equal(alone.begin(), alone.begin() + static_cast<std::ptrdiff_t>(kept),
                               answers[i].room.begin()));
        std::vector<std::uint64_t> bits_a(10), bits_b(10);
        mark_overlaps({job.a, job.b, job.placement}, workspace, bits_a, bits_b);
        ASSERT_TRUE(std::equal(bits_a.begin(), bits_a.end(), marked[i].bits_a.begin())) << i;
        ASSERT_TRUE(std::equal(bits_b.begin(), bits_b.end(), marked[i].bits_b.begin())) << i;
        too_short += alone.size() > kRoom ? 1 : 0;
    }
    EXPECT_GT(too_short, 10u);
}

INSTANTIATE_TEST_SUITE_P(Workers, Batch, testing::Values(1, 2, 3, 8));

TEST(BatchEdges, WhereThereAreFewerAnswersFewerJobsAreAsked) {
    const Jobs made(20);
    std::vector<Workspace> workspaces(4);
    std::vector<std::size_t> counts(20, 12345);
    count_overlaps_many(made.jobs, workspaces, run_threads, std::span(counts).first(7));
    EXPECT_NE(counts[6], 12345u);
    EXPECT_EQ(counts[7], 12345u);
    count_overlaps_many({}, workspaces, run_threads, counts);
    EXPECT_EQ(counts[7], 12345u);
}

// By the headers: a batch needs a workspace, in every build.
TEST(BatchDeathTest, WithoutAWorkspaceTheProgramStops) {
    const Jobs made(2);
    const std::span<Workspace> none;
    constexpr auto kSentence = "A batch needs at least one workspace";
    std::vector<Collision> collisions(2);
    EXPECT_DEATH(collide_many(made.jobs, none, run_threads, collisions), kSentence);
    std::vector<std::optional<Distance>> distances(2);
    EXPECT_DEATH(distance_many(made.jobs, none, run_threads, distances), kSentence);
    std::array<bool, 2> near{};
    EXPECT_DEATH(within_many(made.jobs, 1, none, run_threads, near), kSentence);
    std::vector<std::size_t> counts(2);
    EXPECT_DEATH(count_overlaps_many(made.jobs, none, run_threads, counts), kSentence);
    std::vector<OverlapList> lists(2);
    EXPECT_DEATH(overlaps_many(made.jobs, none, run_threads, lists), kSentence);
    std::vector<OverlapMarks> marks(2);
    EXPECT_DEATH(mark_overlaps_many(made.jobs, none, run_threads, marks), kSentence);
    EXPECT_DEATH((void)split_overlaps(made.jobs[0], none, run_threads, {}), kSentence);
}

}  // namespace
}  // namespace cdprep::test
