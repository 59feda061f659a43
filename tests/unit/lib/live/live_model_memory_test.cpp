// SPDX-License-Identifier: MIT
// In a program of its own, whose memory is all counted.
#include <gtest/gtest.h>

#include <algorithm>

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
    std::vector<TrianglePair> pairs(100'000);
    TestMesh shape = rest;
    std::size_t found = 0;
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
}

}  // namespace
}  // namespace cdprep::test
