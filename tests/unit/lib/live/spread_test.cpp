// SPDX-License-Identifier: MIT
#include "live/spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "live/id_map.h"

namespace cdprep::test {
namespace {

std::vector<SpreadItem> random_items(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> coordinate(-20, 20);  // many are equal
    std::vector<SpreadItem> items;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto next = [&] { return static_cast<float>(coordinate(random)) / 16; };
        items.push_back({{next(), next(), next()}, i, i});
    }
    return items;
}

std::vector<std::uint32_t> ids_of(const std::vector<SpreadItem>& items) {
    std::vector<std::uint32_t> ids;
    for (const SpreadItem& item : items) ids.push_back(item.id);
    return ids;
}

TEST(Spread, GivesEachLeafItsShareInAnyOrderOfItems) {
    for (const std::uint32_t leaves : {1U, 2U, 7U, 8U, 9U, 63U, 64U, 65U, 600U}) {
        for (const Fill fill : {Fill::even, Fill::full}) {
            for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{leaves},
                                            std::size_t{5} * leaves, std::size_t{8} * leaves}) {
                std::vector<SpreadItem> items = random_items(count, leaves);
                std::vector<SpreadItem> shuffled = items;
                std::ranges::shuffle(shuffled, std::mt19937(1));
                spread(items, leaves, fill);
                spread(shuffled, leaves, fill);
                EXPECT_EQ(ids_of(items), ids_of(shuffled));
                for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
                    const std::size_t first = first_in_leaf(count, leaf, leaves, fill);
                    const std::size_t last = first_in_leaf(count, leaf + 1, leaves, fill);
                    EXPECT_LE(last - first, 8U);
                    if (fill == Fill::even) {
                        EXPECT_LE(count / leaves, last - first);
                    } else {
                        EXPECT_TRUE(last - first == 8 || last == count);
                    }
                    EXPECT_TRUE(std::ranges::is_sorted(
                        items.begin() + static_cast<std::ptrdiff_t>(first),
                        items.begin() + static_cast<std::ptrdiff_t>(last), {}, &SpreadItem::id));
                }
                std::vector<std::uint32_t> all = ids_of(items);
                std::ranges::sort(all);
                EXPECT_TRUE(std::ranges::equal(all, ids_of(random_items(count, leaves))));
            }
        }
    }
}

// Along a line, leaves follow each other.
TEST(Spread, PutsNeighboursInOneLeaf) {
    std::vector<SpreadItem> items;
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const std::uint32_t at = i * 2003 % 4000;
        items.push_back({{static_cast<float>(at), 0, 0}, i, at});
    }
    spread(items, 512, Fill::even);
    for (std::uint32_t leaf = 0; leaf < 512; ++leaf) {
        for (std::size_t i = first_in_leaf(4000, leaf, 512, Fill::even);
             i < first_in_leaf(4000, leaf + 1, 512, Fill::even); ++i) {
            EXPECT_GE(items[i].from, first_in_leaf(4000, leaf, 512, Fill::even));
            EXPECT_LT(items[i].from, first_in_leaf(4000, leaf + 1, 512, Fill::even));
        }
    }
}

// Against a map of the standard library, with numbers that share slots.
TEST(IdMap, HoldsWhatAMapHolds) {
    constexpr std::size_t kMost = 300;
    Carver measure(nullptr);
    const IdMap unused(measure, kMost);
    std::vector<std::byte> memory(measure.used() + kCarveAlignment);
    void* start = memory.data();
    std::size_t space = memory.size();
    Carver carver(static_cast<std::byte*>(std::align(kCarveAlignment, 1, start, space)));
    IdMap map(carver, kMost);
    std::map<std::uint32_t, std::uint32_t> expected;
    std::mt19937 random(7);
    for (std::uint32_t step = 0; step < 20'000; ++step) {
        const std::uint32_t id = random() % 600 * (step % 3 == 0 ? 1 : 4096);
        if (random() % 2 == 0 && expected.size() < kMost) {
            map.set(id, step);
            expected[id] = step;
        } else {
            map.erase(id);
            expected.erase(id);
        }
        if (step % 50 != 0) continue;
        for (const auto& [key, place] : expected) ASSERT_EQ(map.find(key), place);
        for (std::uint32_t i = 0; i < 600; ++i) {
            ASSERT_EQ(map.find(i) == IdMap::kNone, expected.count(i) == 0);
        }
    }
}

}  // namespace
}  // namespace cdprep::test
