// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/sort_pairs.h"

namespace cdprep::test {
namespace {

/// Pairs of numbers below 2^bits, more or less often the same.
std::vector<TrianglePair> random_pairs(std::mt19937& random, std::size_t count, int bits_a,
                                       int bits_b, TrianglePair from) {
    std::vector<TrianglePair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const auto below = [&](int bits) {
            return static_cast<std::uint32_t>(random() & ((std::uint64_t{1} << bits) - 1));
        };
        pairs.push_back({from.a + below(bits_a), from.b + below(bits_b)});
    }
    return pairs;
}

// The truth: std::sort.
TEST(SortPairs, SortsAsTheStandardLibraryDoes) {
    std::mt19937 random(1);
    SortScratch scratch;
    for (const std::size_t count : {0, 1, 2, 64, 65, 300, 4096, 4097, 20'000, 200'000}) {
        for (const int bits_a : {0, 1, 7, 9, 20, 32}) {
            for (const int bits_b : {0, 3, 8, 17, 32}) {
                for (const TrianglePair& from : {TrianglePair{0, 0}, TrianglePair{77, 1U << 31}}) {
                    auto pairs = random_pairs(random, count, bits_a, bits_b, from);
                    auto expected = pairs;
                    std::sort(expected.begin(), expected.end());
                    sort_pairs(pairs, scratch);
                    ASSERT_EQ(pairs, expected) << count << ", " << bits_a << ", " << bits_b;
                }
            }
        }
    }
}

// By definition: all are still there, and no part reaches into the next.
TEST(SortPairs, PartsFollowEachOther) {
    std::mt19937 random(2);
    for (const std::size_t count : {0, 1, 100, 10'000}) {
        auto pairs = random_pairs(random, count, 13, 20, {5, 9});
        auto expected = pairs;
        const PairParts parts = divide_pairs(pairs);
        EXPECT_EQ(parts.first.front(), 0u);
        EXPECT_EQ(parts.first.back(), count);
        std::size_t used = 0;
        for (std::size_t i = 0; i < PairParts::kParts; ++i) {
            ASSERT_LE(parts.first[i], parts.first[i + 1]);
            used += parts.first[i] < parts.first[i + 1] ? 1 : 0;
            std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(parts.first[i]),
                      pairs.begin() + static_cast<std::ptrdiff_t>(parts.first[i + 1]));
        }
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(pairs, expected);
        if (count == 10'000) {
            EXPECT_GT(used, 100u);
        }
    }
}

}  // namespace
}  // namespace cdprep::test
