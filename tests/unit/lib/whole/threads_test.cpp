// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <span>
#include <string_view>
#include <thread>

#include "cdprep/pairs.h"
#include "cdprep/points.h"
#include "cdprep/self.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/run_threads.h"
#include "support/scratch_folder.h"

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
    std::array<std::vector<std::uint32_t>, 4> touching;
    std::array<bool, 5> touched{};
    double to_capsule = 0;
    double to_triangle = 0;
    friend bool operator==(const Answers&, const Answers&) = default;
};

template <class Shape>
std::vector<std::uint32_t> all_touching(const Model& model, const Shape& shape,
                                        Workspace& workspace) {
    std::vector<std::uint32_t> triangles(model.triangle_count());
    triangles.resize(touching_triangles(model, shape, workspace, triangles));
    return triangles;
}

void ask_about_shapes(const Model& a, const Double3& at, Workspace& workspace, Answers& answers) {
    const Box box = {{at.x - 0.5, at.y - 0.5, at.z}, {at.x, at.y, at.z + 0.5}};
    const Sphere sphere = {at, 0.5};
    const Capsule capsule = {at, {0, 0, at.z}, 0.25};
    const TriangleShape triangle = {{at, {at.x, 0, 0}, {0, at.y, 1}}};
    answers.touching = {all_touching(a, box, workspace), all_touching(a, sphere, workspace),
                        all_touching(a, capsule, workspace), all_touching(a, triangle, workspace)};
    answers.touched = {touches(a, box, workspace), touches(a, sphere, workspace),
                       touches(a, capsule, workspace), touches(a, triangle, workspace),
                       ray_hits(a, {at, {-1, 0.5, 0.25}}, workspace)};
    answers.to_capsule = shape_distance(a, capsule, workspace)->upper;
    answers.to_triangle = shape_distance(a, triangle, workspace)->lower;
}

Answers ask(const Model& a, const Model& b, const Placement& placement, Workspace& workspace) {
    Answers answers;
    answers.pairs = all_pairs(a, b, placement, workspace);
    answers.hit = collide({a, b, placement, {.body = Body::solid}}, workspace).hit == Answer::yes;
    answers.within = within({a, b, placement}, 0.25, workspace);
    const auto found = distance({a, b, placement}, workspace);
    answers.lower = found->lower;
    answers.upper = found->upper;
    answers.nearest = found->triangle_b;
    const Double3 from = placement.pose_b().translation();
    if (const auto hit = cast_ray(a, {from, {1, 0.5, 0.25}}, workspace)) answers.ray = hit->t;
    answers.closest = closest_point(a, from, workspace)->upper;
    ask_about_shapes(a, from, workspace, answers);
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

/// The scratch of one thread that asks all kinds of questions.
struct Scratch {
    Workspace workspace;
    PairCache cache;
    std::vector<TrianglePair> pairs = std::vector<TrianglePair>(64);
    std::vector<std::uint64_t> bits_a = std::vector<std::uint64_t>(8);
    std::vector<std::uint64_t> bits_b = std::vector<std::uint64_t>(8);
};

std::uint64_t folded(std::uint64_t sum, double number) {
    return (sum ^ std::bit_cast<std::uint64_t>(number)) * 0x100000001b3;
}

std::uint64_t folded(const std::optional<Distance>& found) {
    if (!found) return 1;
    return folded(folded(folded(found->triangle_a, found->triangle_b), found->lower), found->upper);
}

/// The pairs that there was room for, and how many there are.
std::uint64_t folded(std::span<const TrianglePair> pairs, std::size_t count) {
    std::uint64_t sum = 0;
    for (const TrianglePair& pair : pairs.first(std::min(count, pairs.size()))) {
        sum = folded(folded(sum, pair.a), pair.b);
    }
    return sum + count;
}

constexpr std::size_t kKinds = 16;

/// Asks a question of one kind and folds all of its answer into one number.
std::uint64_t ask(std::size_t kind, const Model& a, const Model& b, const Placement& placement,
                  Scratch& scratch) {
    Workspace& workspace = scratch.workspace;
    const Double3& from = placement.pose_b().translation();
    std::uint64_t sum = 0;
    switch (kind) {
        case 0:
            return collide({a, b, placement}, workspace).hit == Answer::yes ? 1 : 0;
        case 1: {
            const Collision found = collide({a, b, placement, {.body = Body::solid}}, workspace);
            return folded(found.hit == Answer::yes ? 1 : 0, found.containment.winding);
        }
        case 2:
            return collide({a, b, placement, {}, &scratch.cache}, workspace).hit == Answer::yes ? 1
                                                                                                : 0;
        case 3:
            return overlaps({a, b, placement}, workspace, {}) + self_overlaps(b, workspace, {});
        case 4: {
            const std::size_t count = overlaps({a, b, placement}, workspace, scratch.pairs);
            return folded(scratch.pairs, count);
        }
        case 5: {
            const auto visit = [&](const TrianglePair& pair) {
                sum += folded(pair.a, pair.b);
                return true;
            };
            visit_overlaps({a, b, placement}, workspace, visit);
            return sum;
        }
        case 6:
            mark_overlaps({a, b, placement}, workspace, scratch.bits_a, scratch.bits_b);
            for (const std::uint64_t word : scratch.bits_a) sum = 31 * sum + word;
            for (const std::uint64_t word : scratch.bits_b) sum = 31 * sum + word;
            return sum;
        case 7:
            return folded(distance({a, b, placement}, workspace));
        case 8:
            return folded(distance({a, b, placement, {}, &scratch.cache}, workspace));
        case 9:
            return within({a, b, placement}, 0.25, workspace) ? 1 : 0;
        case 10:
            return within({a, b, placement, {}, &scratch.cache}, 0.25, workspace) ? 1 : 0;
        case 11: {
            const auto hit = cast_ray(a, {from, {1, 0.5, 0.25}}, workspace);
            return hit ? folded(hit->triangle, hit->t) : 1;
        }
        case 12: {
            const auto closest = closest_point(a, from, workspace);
            return folded(folded(closest->triangle, closest->lower), closest->upper);
        }
        case 13: {
            const std::size_t count =
                pairs_within({a, b, placement}, 0.0625, workspace, scratch.pairs);
            return folded(scratch.pairs, count);
        }
        case 14: {
            const auto visit = [&](const TrianglePair& pair) {
                sum += folded(pair.a, pair.b);
                return true;
            };
            visit_pairs_within({a, b, placement}, 0.125, workspace, visit);
            return sum;
        }
        default: {
            const Inclusion found = points_inside(a, from, workspace);
            return folded(found.on_surface ? 1 : 0, found.winding);
        }
    }
}

/// A million under the thread sanitizer (tests/full/sanitizers), else a sample.
std::size_t questions() {
    const char* all = std::getenv("CDPREP_ALL_QUESTIONS");
    return all != nullptr && std::string_view(all) == "yes" ? 1'000'000 : 40'000;
}

// The truth: what one thread was told before.
TEST(Threads, EightAskMixedQuestionsOfOneMapping) {
    const ScratchFolder folder;
    const AlignedBytes ball = bake_tiny(icosphere(1).positions, icosphere(1).triangles);
    const TestMesh ring = torus(1, 0.25, 12, 6);
    const AlignedBytes ring_bytes = bake_tiny(ring.positions, ring.triangles);
    const auto a = Model::open(folder.write("ball", ball.span()));
    const auto b = Model::open(folder.write("ring", ring_bytes.span()));
    ASSERT_TRUE(a && b);
    std::mt19937 random(19);
    std::vector<Placement> placements;
    std::vector<std::uint64_t> expected;
    Scratch serial;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < 250; ++i) {
        placements.push_back(Placement::b_moves(random_pose(random, 2)));
        for (std::size_t kind = 0; kind < kKinds; ++kind) {
            expected.push_back(ask(kind, a.value(), b.value(), placements.back(), serial));
        }
        hits += expected[i * kKinds];
    }
    EXPECT_GT(hits, placements.size() * 3 / 10);
    EXPECT_LT(hits, placements.size() * 7 / 10);

    const std::size_t count = questions();
    std::array<std::size_t, 8> mismatches{};
    const auto work = [&](std::size_t thread) {
        Scratch scratch;
        std::mt19937 choice(static_cast<std::uint32_t>(thread));
        for (std::size_t i = thread; i < count; i += mismatches.size()) {
            const std::size_t which = choice() % expected.size();
            const Placement& placement = placements[which / kKinds];
            const std::uint64_t found =
                ask(which % kKinds, a.value(), b.value(), placement, scratch);
            mismatches[thread] += found == expected[which] ? 0 : 1;
        }
    };
    run_threads(mismatches.size(), Task(work));
    EXPECT_EQ(mismatches, (std::array<std::size_t, 8>{}));
}

}  // namespace
}  // namespace cdprep::test
