// SPDX-License-Identifier: MIT
#include "live/marked_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>

namespace cdprep {
namespace {

// The reference is a set. A visit takes the marks of some later nodes away, as a node that covers
// others does.
TEST(MarkedNodes, AreVisitedOnceInRisingOrder) {
    constexpr std::uint32_t kNodes = 200;
    alignas(kCarveAlignment) std::array<std::byte, 4096> memory;
    Carver carver(memory.data());
    MarkedNodes marked(carver, kNodes);
    std::mt19937 random(3);
    for (int round = 0; round < 100; ++round) {
        std::set<std::uint32_t> expected;
        for (int i = 0; i < 40; ++i) {
            const std::uint32_t node = random() % kNodes;
            marked.set(node);
            expected.insert(node);
        }
        std::uint32_t last = 0;
        marked.take_all([&](std::uint32_t node) {
            ASSERT_EQ(node, *expected.begin()) << "after " << last;
            expected.erase(expected.begin());
            last = node;
            if (node % 3 != 0) return;
            const std::uint32_t end = std::min(node + 20, kNodes);
            marked.clear(node + 1, end);
            expected.erase(expected.lower_bound(node + 1), expected.lower_bound(end));
        });
        ASSERT_TRUE(expected.empty());
        marked.take_all([](std::uint32_t node) { FAIL() << node << " is still marked"; });
    }
}

}  // namespace
}  // namespace cdprep
