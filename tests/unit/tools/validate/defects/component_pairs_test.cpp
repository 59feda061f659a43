// SPDX-License-Identifier: MIT
// Against a map that keeps every pair of components.
#include "validate/defects/component_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <utility>

namespace cdprep::mesh {
namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;
using Pairs = std::map<Key, ComponentPair>;

void add_to(Pairs& pairs, const ComponentPair& pair) {
    const auto [at, is_new] = pairs.try_emplace({pair.a, pair.b}, pair);
    if (is_new) return;
    at->second.meetings += pair.meetings;
    const Key first = std::min(Key{at->second.first_triangle, at->second.second_triangle},
                               Key{pair.first_triangle, pair.second_triangle});
    at->second.first_triangle = first.first;
    at->second.second_triangle = first.second;
}

void expect_lowest(const std::vector<ComponentPair>& found, const Pairs& truth, std::size_t most) {
    ASSERT_EQ(found.size(), std::min(most, truth.size()));
    auto at = truth.begin();
    for (const ComponentPair& pair : found) {
        ASSERT_EQ((Key{pair.a, pair.b}), at->first);
        ASSERT_EQ(pair.first_triangle, at->second.first_triangle);
        ASSERT_EQ(pair.second_triangle, at->second.second_triangle);
        ASSERT_EQ(pair.meetings, at->second.meetings);
        ++at;
    }
}

/// Each pair of components comes about three times, in an order of its own for each seed.
std::vector<ComponentPair> random_pairs(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<ComponentPair> pairs(600'000);
    for (ComponentPair& pair : pairs) {
        const auto number = [&random](std::uint32_t below) {
            return static_cast<std::uint32_t>(random() % below);
        };
        pair = {number(400), 400 + number(500), number(1000), number(1000), 1 + number(3)};
    }
    return pairs;
}

TEST(ComponentPairs, AreTheLowestWithAllTheirMeetings) {
    const std::vector<ComponentPair> added = random_pairs(1);
    Pairs truth;
    for (const ComponentPair& pair : added) add_to(truth, pair);
    EXPECT_GT(added.size(), 2 * truth.size());
    for (const std::size_t most :
         {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{100'000}, truth.size() - 1,
          truth.size(), truth.size() + 1}) {
        ComponentPairs pairs(most);
        for (const ComponentPair& pair : added) pairs.add(pair);
        expect_lowest(pairs.take(), truth, most);
        EXPECT_EQ(pairs.is_complete(), most >= truth.size()) << most;
    }
}

TEST(ComponentPairs, TheOrderChangesNothing) {
    std::vector<ComponentPair> added = random_pairs(2);
    std::sort(added.begin(), added.end(), [](const auto& x, const auto& y) {
        return Key{x.a, x.b} > Key{y.a, y.b};
    });
    Pairs truth;
    for (const ComponentPair& pair : added) add_to(truth, pair);
    for (int round = 0; round < 2; ++round) {
        ComponentPairs pairs(70'000);
        for (const ComponentPair& pair : added) pairs.add(pair);
        expect_lowest(pairs.take(), truth, 70'000);
        std::reverse(added.begin(), added.end());
    }
}

TEST(ComponentPairs, OfNoneAreNone) {
    ComponentPairs pairs(10);
    EXPECT_TRUE(pairs.take().empty());
    EXPECT_TRUE(pairs.is_complete());
}

}  // namespace
}  // namespace cdprep::mesh
