// SPDX-License-Identifier: MIT
// In a program of its own, whose memory is all counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "support/brute_force.h"
#include "support/counted_memory.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

// A shear over 100 frames, as in samples/deforming.cpp. At ten of them every pair of triangles
// is tested one by one.
TEST(LiveModel, AHundredFramesAllocateNothingAndAnswerAsBruteForce) {
    const TestMesh fixed = torus(1, 0.3, 18, 12);
    const TestMesh rest = torus(1, 0.2, 18, 12);
    const OpenModel other = open_tiny(fixed, {.double_precision = true});
    const auto arrays =
        build::build_model(rest.positions, rest.triangles, {.bounds = build::BvhBounds::aligned});
    ASSERT_TRUE(arrays);
    AlignedBytes memory(LiveModel::bytes(arrays.value()).value());
    auto made = LiveModel::in(memory.span(), arrays.value());
    ASSERT_TRUE(made);
    LiveModel& object = made.value();

    const Placement placement = Placement::b_moves({});
    Workspace workspace;
    std::vector<TrianglePair> pairs(100'000), own_room(10);
    TestMesh shape = rest;
    std::size_t found = 0, own = 0;
    for (int frame = 0; frame < 100; ++frame) {
        const std::size_t before = most = used;
        for (std::size_t i = 0; i < shape.positions.size(); ++i) {
            shape.positions[i].x = rest.positions[i].x + 0.02 * frame * rest.positions[i].z;
            shape.positions[i].y = rest.positions[i].y + 0.01 * frame;
        }
        const bool is_fitted = object.refit(shape.positions).ok();
        const std::size_t count =
            overlaps({object.model(), other.model, placement}, workspace, pairs);
        const auto apart = distance({object.model(), other.model, placement}, workspace);
        own += self_overlaps(object.model(), workspace, own_room);
        EXPECT_EQ(most, before) << "allocated in frame " << frame;
        ASSERT_TRUE(is_fitted);
        ASSERT_LE(count, pairs.size());
        EXPECT_EQ(apart && apart->upper == 0, count > 0);
        if (frame % 10 != 0) continue;
        std::vector<TrianglePair> sorted(pairs.begin(),
                                         pairs.begin() + static_cast<std::ptrdiff_t>(count));
        std::ranges::sort(sorted);
        std::vector<TrianglePair> expected = brute_force_pairs(shape, fixed, placement);
        std::ranges::sort(expected);
        EXPECT_EQ(sorted, expected) << "frame " << frame;
        found += count;
    }
    EXPECT_GT(found, 100U);
    EXPECT_EQ(own, 0U);  // a shear maps no two points to one
}

// A sheet loses a hundredth of its triangles each frame and gets it back. Other triangles come and
// go in turn, so that all subtrees are distributed anew. The sheet waves, and is rebuilt.
TEST(LiveTear, AThousandFramesAllocateNothing) {
    const TestMesh sheet = grid_sheet(40, 40);
    const auto count = static_cast<std::uint32_t>(sheet.triangles.size());
    const auto arrays =
        build::build_model(sheet.positions, sheet.triangles, {.bounds = build::BvhBounds::aligned});
    ASSERT_TRUE(arrays);
    const LiveLimits limits = {.triangles = count};
    AlignedBytes memory(LiveModel::bytes(arrays.value(), limits).value());
    auto made = LiveModel::in(memory.span(), arrays.value(), limits);
    ASSERT_TRUE(made);
    LiveModel& object = made.value();
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    std::vector<Double3> positions = sheet.positions;
    std::size_t rebuilt = 0;
    const std::size_t before = most = used;
    bool is_done = true;
    for (std::uint32_t frame = 0; frame < 1000; ++frame) {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const Double3& p = sheet.positions[i];
            positions[i].z = 3 * std::sin(0.3 * frame + 5 * p.x);
            positions[i].x = p.x * (1 + std::sin(0.1 * frame + 9 * p.y));
        }
        is_done = is_done && object.refit(positions).ok();
        rebuilt += object.rebuild(1'000'000);
        const std::size_t size = count / 100, first = frame * 7 * size % (count - size);
        const auto gone = std::span(numbers).subspan(first, size);
        is_done = is_done && object.remove(gone).ok();
        const auto added = object.append(std::span(sheet.triangles).subspan(first, size));
        if (added) std::iota(gone.begin(), gone.end(), added.value());
        is_done = is_done && added.ok() && object.triangle_count() == count;
    }
    EXPECT_EQ(most, before);
    EXPECT_TRUE(is_done);
    EXPECT_GT(rebuilt, 0U);
}

}  // namespace
}  // namespace cdprep::test
