// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "unit/lib/kernels/each_table.h"

namespace cdprep::kernels {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

using Padded = std::array<float, kPaddedBox>;
using Numbers = std::vector<std::uint32_t>;

constexpr Padded kAbsent = {kInfinite,  kInfinite,  kInfinite,  0,
                            -kInfinite, -kInfinite, -kInfinite, 0};

bool meet(const Padded& a, const Padded& b) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (a[axis] > b[4 + axis] || b[axis] > a[4 + axis]) return false;
    }
    return true;
}

bool holds(const Padded& outer, const Padded& inner) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (outer[axis] > inner[axis] || inner[4 + axis] > outer[4 + axis]) return false;
    }
    return true;
}

/// Boxes on a coarse grid, so that many touch; some are absent.
class Boxes {
public:
    explicit Boxes(std::uint32_t seed) : random_(seed) {}

    Padded next(std::uint32_t places = 10) {
        if (random_() % 8 == 0) return kAbsent;
        Padded box{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box[axis] = static_cast<float>(random_() % places);
            box[4 + axis] = box[axis] + static_cast<float>(random_() % 4);
        }
        return box;
    }
    std::vector<Padded> some(std::size_t count) {
        std::vector<Padded> boxes(count);
        for (Padded& box : boxes) box = next();
        return boxes;
    }

private:
    std::mt19937 random_;
};

/// A tree over boxes in their order.
struct Tree {
    std::vector<std::vector<Padded>> boxes;  ///< [level]
    std::vector<std::vector<float>> nodes;   ///< [level]
    BoxTree view{};

    explicit Tree(std::vector<Padded> leaves) {
        boxes.push_back(std::move(leaves));
        do {
            std::vector<Padded>& level = boxes.back();
            level.resize((level.size() + kLanes - 1) / kLanes * kLanes, kAbsent);
            std::vector<float> stored(level.size() / kLanes * kBoxNode);
            std::vector<Padded> around(level.size() / kLanes, kAbsent);
            for (std::size_t i = 0; i < level.size(); ++i) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    float* node = &stored[i / kLanes * kBoxNode];
                    node[axis * kLanes + i % kLanes] = level[i][axis];
                    node[(3 + axis) * kLanes + i % kLanes] = level[i][4 + axis];
                    Padded& box = around[i / kLanes];
                    box[axis] = std::min(box[axis], level[i][axis]);
                    box[4 + axis] = std::max(box[4 + axis], level[i][4 + axis]);
                }
            }
            nodes.push_back(std::move(stored));
            boxes.push_back(std::move(around));
        } while (boxes.back().size() > 1);
        boxes.pop_back();
        for (const auto& level : nodes) view.level[view.levels++] = level.data();
    }
};

TEST(WorldBoxes, FindsWhatABoxMeetsOnEachLevel) {
    Boxes random(3);
    for (const std::size_t count : {1, 7, 8, 9, 64, 65, 500, 1000}) {
        const Tree tree(random.some(count));
        for (int repeat = 0; repeat < 20; ++repeat) {
            const Padded asked = random.next();
            for (unsigned level = 0; level < tree.view.levels; ++level) {
                const std::vector<Padded>& boxes = tree.boxes[level];
                const std::size_t first = static_cast<std::size_t>(repeat) * boxes.size() / 25;
                Numbers expected;
                for (std::size_t i = first; i < boxes.size(); ++i) {
                    if (meet(asked, boxes[i])) expected.push_back(static_cast<std::uint32_t>(i));
                }
                for_each_table([&](const Table& table) {
                    Numbers found(boxes.size());
                    found.resize(table.met_boxes(tree.view, asked.data(), level,
                                                 static_cast<std::uint32_t>(first), found.data()));
                    ASSERT_EQ(found, expected);
                });
            }
        }
    }
}

TEST(WorldBoxes, FindsPairsOfTwoNodes) {
    Boxes random(5);
    std::size_t all = 0;
    for (int repeat = 0; repeat < 300; ++repeat) {
        const Tree a(random.some(8)), b(random.some(kLanes * kLanes));
        const auto node = static_cast<std::size_t>(repeat % 8);
        BoxPairs expected = 0;
        for (std::size_t i = 0; i < kLanes; ++i) {
            for (std::size_t j = 0; j < kLanes; ++j) {
                const bool found = meet(a.boxes[0][i], b.boxes[0][kLanes * node + j]);
                expected |= BoxPairs{found} << (kLanes * i + j);
            }
        }
        all += static_cast<std::size_t>(expected != 0);
        for_each_table([&](const Table& table) {
            ASSERT_EQ(table.meeting_boxes(a.nodes[0].data(), b.nodes[0].data() + node * kBoxNode,
                                          b.nodes[1].data() + node),
                      expected);
        });
    }
    EXPECT_GT(all, 100U);
}

TEST(WorldBoxes, KeepsPairsThatMeet) {
    Boxes random(7);
    const std::vector<Padded> boxes = random.some(100);
    Numbers pairs, expected;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        for (std::uint32_t b = 0; b < boxes.size(); ++b) {
            pairs.insert(pairs.end(), {a, b});
            if (meet(boxes[a], boxes[b])) expected.insert(expected.end(), {a, b});
        }
    }
    for_each_table([&](const Table& table) {
        Numbers kept = pairs;  // in place
        kept.resize(
            2 * table.meeting_pairs(boxes[0].data(), kept.data(), pairs.size() / 2, kept.data()));
        ASSERT_EQ(kept, expected);
    });
}

/// Boxes as a caller gives them: some are absent along one axis alone, some are infinite.
std::vector<float> given_boxes(const std::vector<Padded>& boxes) {
    std::vector<float> given;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        Padded box = boxes[i];
        if (i % 16 == 5) std::swap(box[i % 3], box[4 + i % 3]);
        if (i % 16 == 6) box[i % 3] = -kInfinite;
        if (i % 16 == 7) box[4 + i % 3] = kInfinite;
        if (i % 16 == 8) box[0] = box[4] = kInfinite;
        given.insert(given.end(), {box[0], box[1], box[2], box[4], box[5], box[6]});
    }
    return given;
}

/// The padded box of six given numbers.
Padded stored_box(const float* given) {
    Padded box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (given[axis] > given[3 + axis]) return kAbsent;
        constexpr float kMost = std::numeric_limits<float>::max();
        box[axis] = std::clamp(given[axis], -kMost, kMost);
        box[4 + axis] = std::clamp(given[3 + axis], -kMost, kMost);
    }
    return box;
}

TEST(WorldBoxes, StoresBoxesAndFindsThoseThatLeft) {
    Boxes random(9);
    const std::vector<Padded> before = random.some(1000);
    const std::vector<float> given = given_boxes(random.some(before.size()));
    std::vector<Padded> around(before.size());
    Numbers named;  // each third box
    std::vector<Padded> boxes = before, previous(before.size());
    Numbers expected;
    for (std::uint32_t i = 0; i < before.size(); ++i) {
        const Padded box = stored_box(&given[i * 6]);
        around[i] = i % 2 == 0 ? box : random.next(4);
        if (i % 3 != 0) continue;
        named.push_back(i);
        boxes[i] = box;
        previous[i] = box;  // that of the first of two
        if (!holds(around[i], box)) expected.push_back(i);
    }
    const Numbers once = named;
    named.insert(named.end(), once.begin(), once.end());  // a box named twice escapes once
    EXPECT_GT(expected.size(), 50U);
    EXPECT_LT(expected.size(), 280U);
    for_each_table([&](const Table& table) {
        std::vector<Padded> stored = before, replaced(before.size());
        std::vector<std::uint8_t> escaped(before.size());
        Numbers found(before.size() + 1);
        const BoxStore store = {given.data(), stored[0].data(), replaced[0].data(),
                                around[0].data(), escaped.data()};
        found.resize(table.store_boxes(store, named.data(), named.size(), found.data()));
        ASSERT_EQ(found, expected);
        ASSERT_EQ(stored, boxes);
        ASSERT_EQ(replaced, previous);
        found.resize(before.size() + 1);
        ASSERT_EQ(table.store_boxes(store, once.data(), once.size(), found.data()), 0U);
        ASSERT_EQ(std::count(escaped.begin(), escaped.end(), 1),
                  static_cast<std::ptrdiff_t>(expected.size()));
        // All of them.
        const std::size_t rest = table.store_boxes(store, nullptr, before.size(), found.data());
        for (std::size_t i = 0; i < before.size(); ++i) {
            ASSERT_EQ(stored[i], stored_box(&given[i * 6])) << i;
            ASSERT_EQ(escaped[i] == 1, !holds(around[i], stored[i])) << i;
        }
        ASSERT_GT(rest, 100U);
    });
}

}  // namespace
}  // namespace cdprep::kernels
