// SPDX-License-Identifier: MIT
// Cases S12 and S13 of the catalogue: a mesh that deforms each frame, and one that tears.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "cdprep/self.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"

namespace cdprep::test {
namespace {

constexpr std::size_t kPairRoom = 4000;

std::uint32_t frames() {
    return asks_all() ? 1000 : 120;
}

build::ModelArrays aligned_arrays(const TestMesh& mesh) {
    return build::build_model(mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned})
        .value();
}

std::vector<TrianglePair> pairs_of(const Model& a, const Model& b, const Placement& placement,
                                   Workspace& workspace) {
    std::vector<TrianglePair> pairs(kPairRoom);
    pairs.resize(overlaps({a, b, placement}, workspace, pairs));
    return pairs;
}

/// The mesh in a frame: sheared, twisted about z, or with noise.
TestMesh deformed(const TestMesh& rest, std::uint32_t frame, std::mt19937& random) {
    TestMesh mesh = rest;
    const double phase = 0.1 * frame;
    std::uniform_real_distribution<double> noise(-0.05, 0.05);
    for (Double3& p : mesh.positions) {
        if (frame % 3 == 0) p.x += std::sin(phase) * p.y;
        if (frame % 3 == 1) {
            const double angle = std::sin(phase) * p.x, c = std::cos(angle), s = std::sin(angle);
            p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
        }
        if (frame % 3 == 2) p = {p.x + noise(random), p.y + noise(random), p.z + noise(random)};
    }
    return mesh;
}

TEST(LiveCases, S12DeformationAnswersAsARebuildAndBruteForceDo) {
    const TestMesh rest = torus(1, 0.3, 24, 12), fixed = icosphere(2);
    const OpenModel other = open_tiny(fixed, {.double_precision = true});
    const auto arrays = aligned_arrays(rest);
    AlignedBytes memory(LiveModel::bytes(arrays).value());
    LiveModel object = LiveModel::in(memory.span(), arrays).value();
    Workspace workspace;
    std::mt19937 random(12);
    std::size_t found = 0;
    double worst_cost = 0;
    for (std::uint32_t frame = 0; frame < frames(); ++frame) {
        const TestMesh now = deformed(rest, frame, random);
        ASSERT_TRUE(object.refit(now.positions));
        const OpenModel anew = open_tiny(now, {.double_precision = true});
        const Placement placement = Placement::b_moves(random_pose(random, 0.5));
        const auto refitted = pairs_of(object.model(), other.model, placement, workspace);
        ASSERT_EQ(refitted, pairs_of(anew.model, other.model, placement, workspace)) << frame;
        found += refitted.size();
        if (frame % 4 == 0) {
            ASSERT_EQ(refitted, brute_force_pairs(now, fixed, placement)) << frame;
        }
        const auto rebuilt = aligned_arrays(now);
        AlignedBytes room(LiveModel::bytes(rebuilt).value());
        const LiveModel fresh = LiveModel::in(room.span(), rebuilt).value();
        worst_cost = std::max(worst_cost, object.surface_cost() / fresh.surface_cost());
    }
    EXPECT_GT(found, 50 * std::size_t{frames()});
    std::printf("surface cost of a refitted tree, times that of a new one: at most %.2f\n",
                worst_cost);
}

/// Triangles by number, as a mesh.
std::pair<TestMesh, std::vector<std::uint32_t>> listed(const LiveModel& object,
                                                       const std::vector<Double3>& positions) {
    std::vector<LiveTriangle> all(object.triangle_count());
    object.triangles(all);
    TestMesh mesh{positions, {}};
    std::vector<std::uint32_t> numbers;
    for (const LiveTriangle& triangle : all) {
        mesh.triangles.push_back({triangle.vertex});
        numbers.push_back(triangle.number);
    }
    return {mesh, numbers};
}

TEST(LiveCases, S13TearingAnswersAsBruteForceDoes) {
    const TestMesh sheet = grid_sheet(30, 30), fixed = moved_by(icosphere(2), 6, {15, 15, 0});
    const OpenModel other = open_tiny(fixed, {.double_precision = true});
    const auto count = static_cast<std::uint32_t>(sheet.triangles.size());
    const auto arrays = aligned_arrays(sheet);
    AlignedBytes memory(LiveModel::bytes(arrays, {.triangles = count}).value());
    LiveModel object = LiveModel::in(memory.span(), arrays, {.triangles = count}).value();
    Workspace workspace;
    std::mt19937 random(13);
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    TestMesh now = sheet;
    std::size_t found = 0;
    for (std::uint32_t frame = 0; frame < frames(); ++frame) {
        const std::uint32_t size = count / 100, first = random() % (count - size);
        const auto gone = std::span(numbers).subspan(first, size);
        ASSERT_TRUE(object.remove(gone));
        const auto added = object.append(std::span(sheet.triangles).subspan(first, size));
        ASSERT_TRUE(added);
        std::iota(gone.begin(), gone.end(), added.value());
        for (Double3& p : now.positions) p.z = std::sin(0.1 * frame + p.x);
        ASSERT_TRUE(object.refit(now.positions));
        if (frame % 10 != 0) continue;
        const Placement placement = Placement::b_moves(Pose());
        const auto [mesh, by] = listed(object, now.positions);
        auto expected = brute_force_pairs(mesh, fixed, placement);
        for (TrianglePair& pair : expected) pair.a = by[pair.a];
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(pairs_of(object.model(), other.model, placement, workspace), expected) << frame;
        ASSERT_EQ(self_overlaps(object.model(), workspace, {}), 0U);
        found += expected.size();
    }
    EXPECT_GT(found, std::size_t{frames()});
}

}  // namespace
}  // namespace cdprep::test
