// SPDX-License-Identifier: MIT
// Boxes in world coordinates against boxes in world coordinates. Included by kernel sources alone.
// Nothing is rounded, so the answers are the same for every table.
#pragma once

#include <cassert>

#include "kernels.h"

namespace cdprep::kernels {
namespace {

/// Eight boxes.
template <class F>
struct BoxLanes {
    F lower[3], upper[3];

    /// Loads the boxes of a node.
    static BoxLanes of_node(const float* node) noexcept {
        BoxLanes boxes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            boxes.lower[axis] = F::load(node + axis * kLanes);
            boxes.upper[axis] = F::load(node + (3 + axis) * kLanes);
        }
        return boxes;
    }
    /// Repeats one box. Its numbers are `stride` apart, the upper ones `to_upper` after the lower.
    static BoxLanes repeat(const float* box, std::size_t stride, std::size_t to_upper) noexcept {
        BoxLanes boxes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            boxes.lower[axis] = F(box[axis * stride]);
            boxes.upper[axis] = F(box[axis * stride + to_upper]);
        }
        return boxes;
    }
    /// Repeats the box of one lane of a node.
    static BoxLanes of_lane(const float* node, std::size_t lane) noexcept {
        return repeat(node + lane, kLanes, 3 * kLanes);
    }
};

/// Returns the lanes whose boxes meet, as a bit set.
template <class F>
unsigned meeting_lanes(const BoxLanes<F>& a, const BoxLanes<F>& b) noexcept {
    auto apart = greater(a.lower[0], b.upper[0]) | greater(b.lower[0], a.upper[0]);
    for (std::size_t axis = 1; axis < 3; ++axis) {
        apart =
            apart | greater(a.lower[axis], b.upper[axis]) | greater(b.lower[axis], a.upper[axis]);
    }
    return ~bits(apart) & 0xff;
}

/// Returns the children of a node, on the level below `level`, that reach the number `first` on
/// level `until`.
inline unsigned lanes_from(std::uint64_t node, unsigned level, unsigned until,
                           std::uint64_t first) noexcept {
    const unsigned shift = 3 * (level - until);
    const std::uint64_t least = first >> shift;  // the child that holds `first`
    if (least <= node * kLanes) return 0xff;
    return least >= (node + 1) * kLanes ? 0 : 0xffU << (least - node * kLanes) & 0xff;
}

/// The body of met_boxes(): depth first, so that numbers rise.
template <class F>
std::size_t met_boxes_of(const BoxTree& tree, const float* box, unsigned until, std::uint32_t first,
                         std::uint32_t* found) noexcept {
    assert(until < tree.levels && tree.levels <= kMostBoxLevels);
    const BoxLanes<F> asked = BoxLanes<F>::repeat(box, 1, kPaddedUpper);
    std::uint64_t node[kMostBoxLevels];
    unsigned lanes[kMostBoxLevels];
    std::size_t count = 0;
    const auto enter = [&](unsigned level, std::uint64_t number) {
        node[level] = number;
        const float* boxes = tree.level[level] + number * kBoxNode;
        lanes[level] = meeting_lanes(BoxLanes<F>::of_node(boxes), asked) &
                       lanes_from(number, level, until, first);
    };
    unsigned level = tree.levels - 1;
    enter(level, 0);
    while (true) {
        if (lanes[level] == 0) {
            if (++level == tree.levels) return count;
            continue;
        }
        const auto lane = format::lowest_set_bit(lanes[level]);
        lanes[level] &= lanes[level] - 1;
        const std::uint64_t child = node[level] * kLanes + lane;
        if (level == until) {
            found[count++] = static_cast<std::uint32_t>(child);
        } else {
            enter(--level, child);
        }
    }
}

/// The body of meeting_boxes().
template <class F>
BoxPairs meeting_boxes_of(const float* a, const float* b, const float* around_b) noexcept {
    const BoxLanes<F> of_a = BoxLanes<F>::of_node(a), of_b = BoxLanes<F>::of_node(b);
    BoxPairs pairs = 0;
    unsigned near = meeting_lanes(of_a, BoxLanes<F>::of_lane(around_b, 0));
    for (; near != 0; near &= near - 1) {
        const auto lane = format::lowest_set_bit(near);
        const unsigned met = meeting_lanes(BoxLanes<F>::of_lane(a, lane), of_b);
        pairs |= BoxPairs{met} << (kLanes * lane);
    }
    return pairs;
}

inline constexpr unsigned kLowerLanes = 0x0f;  ///< of a padded box
inline constexpr unsigned kUpperLanes = 0xf0;

/// The body of meeting_pairs().
template <class F>
std::size_t meeting_pairs_of(const float* boxes, const std::uint32_t* pairs, std::size_t count,
                             std::uint32_t* kept) noexcept {
    std::size_t number = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t one = pairs[2 * i], two = pairs[2 * i + 1];
        const F a = F::load(boxes + one * kPaddedBox);
        const F b = halves_exchanged(F::load(boxes + two * kPaddedBox));
        const unsigned apart =
            (bits(greater(a, b)) & kLowerLanes) | (bits(greater(b, a)) & kUpperLanes);
        kept[2 * number] = pairs[2 * i];
        kept[2 * number + 1] = pairs[2 * i + 1];
        number += static_cast<std::size_t>(apart == 0);
    }
    return number;
}

/// The body of store_boxes().
template <class F>
std::size_t store_boxes_of(const BoxStore& store, const std::uint32_t* numbers, std::size_t count,
                           std::uint32_t* escaped) noexcept {
    constexpr float kLargest = 0x1.fffffep127F;  // the largest float
    const F most(kLargest), least(-kLargest);
    const BoxStore to = store;  // in registers: bytes that are stored may be anything
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t number = numbers == nullptr ? i : numbers[i];
        const std::size_t at = number * kPaddedBox;
        F::load(to.boxes + at).store(to.previous + at);
        const F given = F::load_box(to.given + number * 6);
        const unsigned is_absent = bits(greater(given, halves_exchanged(given))) & kLowerLanes;
        const F box = is_absent != 0 ? F::load(kAbsentBox) : max(min(given, most), least);
        box.store(to.boxes + at);
        const F around = F::load(to.around + at);
        const unsigned outside =
            (bits(greater(around, box)) & kLowerLanes) | (bits(greater(box, around)) & kUpperLanes);
        const auto is_new = static_cast<std::uint8_t>((outside != 0) & (to.escaped[number] == 0));
        to.escaped[number] |= is_new;
        escaped[found] = static_cast<std::uint32_t>(number);
        found += is_new;
    }
    return found;
}

}  // namespace
}  // namespace cdprep::kernels
