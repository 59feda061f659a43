// SPDX-License-Identifier: MIT
#include "scene/world_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/curve.h"

namespace cdprep {
namespace {

using kernels::kAbsentBox;
using kernels::kBoxNode;
using kernels::kLanes;
using kernels::kPaddedBox;
using kernels::kPaddedUpper;

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();

// A key holds the place on the curve, a bit for large boxes above it, and the number of the box.
constexpr int kCurveBits = 10;  ///< of each axis
constexpr int kKeyBits = 3 * kCurveBits + 1;
constexpr int kDigitBits = 11;
constexpr float kCells = 1 << kCurveBits;
constexpr float kLarge = 0.125F;  ///< of the scene

std::size_t groups_of(std::size_t count) noexcept {
    return (count + kLanes - 1) / kLanes;
}

std::size_t node_count(std::size_t boxes) noexcept {
    std::size_t all = 0, level = boxes;
    do {
        level = std::max<std::size_t>(groups_of(level), 1);
        all += level;
    } while (level > 1);
    return all + 1;  // level 1 is there for one leaf too
}

/// The box around the middles of all boxes that are there, along axes where they are finite.
struct Middles {
    std::array<float, 3> lower = {kInfinite, kInfinite, kInfinite};
    std::array<float, 3> upper = {-kInfinite, -kInfinite, -kInfinite};

    static float middle(const float* box, std::size_t axis) noexcept {
        return 0.5F * box[axis] + 0.5F * box[kPaddedUpper + axis];
    }
    void add(const float* box) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // The middle of a box that is infinite on one side would leave all others in one cell.
            if (!(box[axis] > -kLargest && box[kPaddedUpper + axis] < kLargest)) continue;
            const float m = middle(box, axis);
            lower[axis] = std::min(lower[axis], m);
            upper[axis] = std::max(upper[axis], m);
        }
    }
    [[nodiscard]] float extent() const noexcept {
        float most = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            most = std::max(most, upper[axis] - lower[axis]);
        }
        return std::min(most, kLargest);
    }
};

/// Sorts keys by the bits above the number of the box. Stable, so equal keys stay in the order of
/// their boxes. Returns the array that holds them.
std::uint64_t* sort_keys(std::uint64_t* keys, std::uint64_t* other, std::size_t count) noexcept {
    for (int shift = 32; shift < 32 + kKeyBits; shift += kDigitBits) {
        constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
        const auto digit = [&](std::uint64_t key) { return (key >> shift) % kDigits; };
        std::array<std::uint32_t, kDigits> next{};
        for (std::size_t i = 0; i < count; ++i) ++next[digit(keys[i])];
        std::uint32_t sum = 0;
        for (std::uint32_t& place : next) sum += std::exchange(place, sum);
        for (std::size_t i = 0; i < count; ++i) other[next[digit(keys[i])]++] = keys[i];
        std::swap(keys, other);
    }
    return keys;
}

/// Returns the least of eight numbers, or the greatest.
template <class Choose>
float reduce(const float* eight, Choose choose) noexcept {
    return choose(choose(choose(eight[0], eight[1]), choose(eight[2], eight[3])),
                  choose(choose(eight[4], eight[5]), choose(eight[6], eight[7])));
}

/// Returns the padded box around the boxes of a node.
std::array<float, kPaddedBox> box_around(const float* node) noexcept {
    constexpr auto least = [](float a, float b) { return b < a ? b : a; };
    constexpr auto most = [](float a, float b) { return b > a ? b : a; };
    std::array<float, kPaddedBox> box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box[axis] = reduce(node + axis * kLanes, least);
        box[kPaddedUpper + axis] = reduce(node + (3 + axis) * kLanes, most);
    }
    return box;
}

}  // namespace

WorldTree::WorldTree(Carver& carver, std::uint32_t most) noexcept
    : nodes_(carver.take<float>(std::uint64_t{kBoxNode} * node_count(most))),
      box_at_(carver.take<std::uint32_t>(groups_of(most) * kLanes)),
      place_of_(carver.take<std::uint32_t>(most)),
      keys_(carver.take<std::uint64_t>(most)),
      sorted_(carver.take<std::uint64_t>(most)) {}

void WorldTree::build(const float* boxes, std::uint32_t count) noexcept {
    count_ = count;
    shape();
    choose_order(boxes);
    rebuild(boxes);
}

void WorldTree::shape() noexcept {
    float* next = nodes_;
    std::size_t count = count_;
    view_.levels = 0;
    do {
        count = std::max<std::size_t>(groups_of(count), 1);
        assert(view_.levels < kernels::kMostBoxLevels);
        view_.level[view_.levels] = level_[view_.levels] = next;
        ++view_.levels;
        next += count * kBoxNode;
    } while (count > 1 || view_.levels < 2);
}

void WorldTree::choose_order(const float* boxes) noexcept {
    Middles middles;
    for (std::size_t i = 0; i < count_; ++i) middles.add(boxes + i * kPaddedBox);
    const float extent = middles.extent();
    const float scale = extent > 0 ? (kCells - 1) / extent : 0;
    const auto code = kernels::active_curve().code;
    for (std::size_t i = 0; i < count_; ++i) {
        const float* box = boxes + i * kPaddedBox;
        std::array<std::uint32_t, 3> cell{};
        bool is_large = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float at = (Middles::middle(box, axis) - middles.lower[axis]) * scale;
            if (at > 0) cell[axis] = static_cast<std::uint32_t>(std::min(at, kCells - 1));
            is_large |= box[kPaddedUpper + axis] - box[axis] > kLarge * extent;
        }
        const std::uint64_t place = code(cell[0], cell[1], cell[2]) | std::uint64_t{is_large}
                                                                          << (3 * kCurveBits);
        keys_[i] = place << 32 | i;
    }
    const std::uint64_t* sorted = sort_keys(keys_, sorted_, count_);
    for (std::size_t place = 0; place < count_; ++place) {
        const auto number = static_cast<std::uint32_t>(sorted[place]);
        box_at_[place] = number;
        place_of_[number] = static_cast<std::uint32_t>(place);
    }
}

void WorldTree::set_lane(unsigned level, std::size_t place, const float* box) noexcept {
    float* const lane = level_[level] + place / kLanes * kBoxNode + place % kLanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lane[axis * kLanes] = box[axis];
        lane[(3 + axis) * kLanes] = box[kPaddedUpper + axis];
    }
}

void WorldTree::rebuild(const float* boxes) noexcept {
    std::size_t count = count_;
    for (std::size_t place = 0; place < count; ++place) {
        set_lane(0, place, boxes + std::size_t{box_at_[place]} * kPaddedBox);
    }
    for (unsigned level = 0; level < view_.levels; ++level) {
        const std::size_t nodes = std::max<std::size_t>(groups_of(count), 1);
        for (std::size_t place = count; place < nodes * kLanes; ++place) {
            set_lane(level, place, kAbsentBox);
        }
        if (level + 1 == view_.levels) break;
        for (std::size_t i = 0; i < nodes; ++i) {
            set_lane(level + 1, i, box_around(node(level, i)).data());
        }
        count = nodes;
    }
}

void WorldTree::set(std::uint32_t number, const float* box) noexcept {
    std::size_t place = place_of_[number];
    set_lane(0, place, box);
    for (unsigned level = 1; level < view_.levels; ++level) {
        place /= kLanes;
        set_lane(level, place, box_around(node(level - 1, place)).data());
    }
}

}  // namespace cdprep
