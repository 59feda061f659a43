// SPDX-License-Identifier: MIT
#include "pieces/ways_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace cdprep {
namespace {

// The reference is a stable sort of all ways: of equal ones, those that came first.
TEST(WaysOut, TheShortestComeInOrder) {
    std::mt19937 random(5);
    WaysOut ways;
    for (std::size_t count = 1; count < 300; ++count) {
        ways.clear();
        std::vector<WayOut> all;
        for (std::size_t i = 0; i < count; ++i) {
            const auto length = static_cast<double>(random() % 50);
            all.push_back({{static_cast<double>(i), 0, 0}, length, WayKind::other, 0, 0});
            ways.add(all.back().normal, length);
        }
        std::stable_sort(all.begin(), all.end(),
                         [](const WayOut& x, const WayOut& y) { return x.length < y.length; });
        ASSERT_EQ(ways.count(), std::min(count, WaysOut::kMost));
        for (std::size_t i = 0; i < ways.count(); ++i) {
            ASSERT_EQ(ways[i].normal.x, all[i].normal.x) << count;
        }
    }
}

// Lengths that overflow have no order, and are no reason to read elsewhere.
TEST(WaysOut, LengthsThatAreNoNumbersComeLast) {
    WaysOut ways;
    ways.add({-1, 0, 0}, 3);
    for (int i = 0; i < 300; ++i) {
        ways.add({static_cast<double>(i), 0, 0}, i % 2 == 0 ? std::nan("") : HUGE_VAL);
    }
    ASSERT_EQ(ways.count(), WaysOut::kMost);
    EXPECT_EQ(ways[0].normal.x, -1);
    for (std::size_t i = 1; i < ways.count(); ++i) {
        EXPECT_EQ(ways[i].normal.x, static_cast<double>(i - 1));
    }
}

}  // namespace
}  // namespace cdprep
