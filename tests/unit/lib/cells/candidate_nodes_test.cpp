// SPDX-License-Identifier: MIT
#include "cells/candidate_nodes.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace cdprep {
namespace {

// The oracle: a map. Asked again from each limit on, the passes give every node once, with
// all of its pairs, whatever the room; numbers from a few to far more than there is room for.
TEST(CandidateNodes, PassesGiveEveryNodeOnceWithAllItsPairs) {
    std::mt19937 random(61);
    std::size_t single = 0, many = 0;
    for (int round = 0; round < 160; ++round) {
        const auto set = std::make_unique<CandidateNodes>();
        if (round % 4 != 0) set->set_room(2 + random() % 60);
        const std::uint32_t numbers = 1 + random() % (round % 2 == 0 ? 40 : 4000);
        std::vector<std::pair<std::uint32_t, kernels::BoxPairs>> added;
        std::map<std::uint32_t, kernels::BoxPairs> expected;
        for (std::uint32_t i = 0; i < 2 * numbers; ++i) {
            // Neighbours, and numbers that share their slots.
            const std::uint32_t node = random() % numbers * (round % 3 == 0 ? 1024 : 1);
            const auto pairs = kernels::BoxPairs{1} << (random() % 64);
            added.emplace_back(node, pairs);
            expected[node] |= pairs;
        }
        std::map<std::uint32_t, kernels::BoxPairs> given;
        std::size_t passes = 0;
        for (std::uint32_t from = 0; from != CandidateNodes::kNoLimit; from = set->limit()) {
            set->begin(from);
            for (const auto& [node, pairs] : added) set->add(node, pairs);
            for (const CandidateNode& node : set->nodes()) {
                ASSERT_TRUE(given.emplace(node.node, node.pairs).second) << round;
            }
            ASSERT_GT(set->limit(), from);
            ++passes;
        }
        ASSERT_TRUE(given == expected) << round;
        (passes == 1 ? single : many) += 1;
    }
    EXPECT_GT(single, 30U);
    EXPECT_GT(many, 30U);
}

}  // namespace
}  // namespace cdprep
