// SPDX-License-Identifier: MIT
#include "kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace cdprep::kernels {
namespace {

using Node = std::array<float, 48>;

Node random_node(std::mt19937& random, bool coarse) {
    std::uniform_int_distribution<int> grid(-4, 4);
    std::uniform_real_distribution<float> fine(-1, 1);
    Node node;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t box = 0; box < 8; ++box) {
            const float lower = coarse ? static_cast<float>(grid(random)) / 4 : fine(random);
            const float size =
                coarse ? static_cast<float>(grid(random) + 4) / 4 : std::fabs(fine(random));
            node[8 * axis + box] = lower;
            node[24 + 8 * axis + box] = lower + size;
        }
    }
    return node;
}

BoxPlacement random_placement(std::mt19937& random, bool coarse) {
    std::uniform_real_distribution<float> fine(-1, 1);
    BoxPlacement p{};
    for (std::size_t i = 0; i < 9; ++i) {
        p.rotation[i] = coarse ? (i % 4 == 0 ? 1.0F : 0.0F) : fine(random);
        p.abs_rotation[i] = std::fabs(p.rotation[i]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        p.shift[i] = p.shift_in_b[i] = coarse ? std::round(4 * fine(random)) / 8 : fine(random) / 2;
    }
    p.scale_a = 1;
    p.scale_b = coarse ? 1 : 0.5F;
    p.slack = coarse ? 0 : 1e-6F;
    return p;
}

// The scalar table is the specification. Coarse boxes often share a face exactly.
TEST(Kernels, OverlapMasksAgreeWithScalarOnEveryInstructionSet) {
    std::mt19937 random(20240601);
    std::size_t set = 0, all = 0;
    for (int round = 0; round < 20'000; ++round) {
        const bool coarse = round % 2 == 0;
        const Node a = random_node(random, coarse);
        const Node b = random_node(random, coarse);
        const BoxPlacement placement = random_placement(random, coarse);
        std::array<std::uint8_t, 8> expected{};
        kScalar.overlap_masks(placement, a.data(), b.data(), 0, 8, expected.data());
        const Available tables = available();
        for (std::size_t i = 0; i < tables.count; ++i) {
            std::array<std::uint8_t, 8> found{};
            tables.table[i]->overlap_masks(placement, a.data(), b.data(), 0, 8, found.data());
            ASSERT_EQ(found, expected) << tables.table[i]->name << ", round " << round;
        }
        for (const std::uint8_t mask : expected)
            set += static_cast<unsigned>(__builtin_popcount(mask));
        all += 64;
    }
    // Neither answer may be rare, or this test would prove nothing.
    EXPECT_GT(set, all / 20);
    EXPECT_LT(set, all * 19 / 20);
}

TEST(Kernels, RowsOutsideTheRangeStayUntouched) {
    std::mt19937 random(3);
    const Node a = random_node(random, false), b = random_node(random, false);
    const Available tables = available();
    for (std::size_t i = 0; i < tables.count; ++i) {
        std::array<std::uint8_t, 8> masks{};
        masks.fill(0xa5);
        tables.table[i]->overlap_masks(random_placement(random, false), a.data(), b.data(), 2, 5,
                                       masks.data());
        for (const std::size_t row : {0, 1, 5, 6, 7}) {
            EXPECT_EQ(masks[row], 0xa5) << tables.table[i]->name << ", row " << row;
        }
    }
}

TEST(Kernels, ScalarIsAlwaysAvailable) {
    EXPECT_GE(available().count, 1u);
    EXPECT_STREQ(available().table[0]->name, "scalar");
}

}  // namespace
}  // namespace cdprep::kernels
