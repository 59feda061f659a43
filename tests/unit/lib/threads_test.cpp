// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <thread>

#include "cdprep/cast_ray.h"
#include "cdprep/closest_point.h"
#include "cdprep/collide.h"
#include "cdprep/distance.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

/// What all questions say about one placement, in numbers that can be compared.
struct Answers {
    std::vector<TrianglePair> pairs;
    bool hit = false;
    bool within = false;
    double lower = 0;
    double upper = 0;
    std::uint32_t nearest = 0;
    double ray = 0;
    double closest = 0;
    friend bool operator==(const Answers&, const Answers&) = default;
};

Answers ask(const Model& a, const Model& b, const Placement& placement, Workspace& workspace) {
    Answers answers;
    answers.pairs = all_pairs(a, b, placement, workspace);
    answers.hit = collide(a, b, placement, workspace, {.as = As::solid}).hit;
    answers.within = is_within(a, b, placement, 0.25, workspace);
    const auto found = distance(a, b, placement, workspace);
    answers.lower = found->lower;
    answers.upper = found->upper;
    answers.nearest = found->triangle_b;
    const Double3 from = placement.pose_b().translation();
    if (const auto hit = cast_ray(a, {from, {1, 0.5, 0.25}}, workspace)) answers.ray = hit->t;
    answers.closest = closest_point(a, from, workspace)->upper;
    return answers;
}

// Models are shared, workspaces are not: eight threads say what one says.
TEST(Threads, ShareModelsAndAgree) {
    const OpenModel sphere = open_tiny(icosphere(3));
    const OpenModel ring = open_tiny(torus(1, 0.25, 24, 12));
    std::mt19937 random(17);
    std::vector<Placement> placements;
    for (int i = 0; i < 40; ++i) {
        placements.push_back(Placement::b_moves(random_pose(random, i % 2 == 0 ? 0.5 : 2)));
    }
    std::vector<Answers> expected;
    Workspace serial;
    for (const Placement& p : placements) {
        expected.push_back(ask(sphere.model, ring.model, p, serial));
    }
    std::vector<std::size_t> mismatches(8, 0);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < mismatches.size(); ++t) {
        threads.emplace_back([&, t] {
            Workspace workspace;
            for (std::size_t i = 0; i < placements.size(); ++i) {
                const Answers found = ask(sphere.model, ring.model, placements[i], workspace);
                mismatches[t] += found == expected[i] ? 0 : 1;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(mismatches, std::vector<std::size_t>(8, 0));
}

}  // namespace
}  // namespace cdprep::test
