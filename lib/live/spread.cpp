// SPDX-License-Identifier: MIT
#include "live/spread.h"

#include <algorithm>

namespace cdprep {
namespace {

/// Returns the axis along which the middles of items spread most.
std::size_t longest_axis(std::span<const SpreadItem> items) {
    std::array<float, 3> lower = items.front().middle;
    std::array<float, 3> upper = lower;
    for (const SpreadItem& item : items) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], item.middle[axis]);
            upper[axis] = std::max(upper[axis], item.middle[axis]);
        }
    }
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
        if (upper[axis] - lower[axis] > upper[longest] - lower[longest]) longest = axis;
    }
    return longest;
}

/// Returns the leaf between whole children, about in the middle.
std::uint32_t middle_leaf(std::uint32_t first, std::uint32_t last) {
    const std::uint32_t leaves = last - first;
    std::uint32_t child = 1;
    while (child * format::kBvhWidth < leaves) child *= format::kBvhWidth;
    const std::uint32_t children = (leaves + child - 1) / child;
    return first + children / 2 * child;
}

struct Spread {
    std::span<SpreadItem> items;
    std::uint32_t leaves;
    Fill fill;

    void split(std::uint32_t first, std::uint32_t last) const {
        const std::size_t begin = first_in_leaf(items.size(), first, leaves, fill);
        const std::size_t end = first_in_leaf(items.size(), last, leaves, fill);
        const std::span<SpreadItem> part = items.subspan(begin, end - begin);
        if (part.empty()) return;
        if (last - first == 1) {
            std::ranges::sort(part, {}, &SpreadItem::id);
            return;
        }
        const std::uint32_t middle = middle_leaf(first, last);
        const std::size_t cut = first_in_leaf(items.size(), middle, leaves, fill) - begin;
        const std::size_t axis = longest_axis(part);
        std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(cut), part.end(),
                         [&](const SpreadItem& a, const SpreadItem& b) {
                             if (a.middle[axis] != b.middle[axis]) {
                                 return a.middle[axis] < b.middle[axis];
                             }
                             return a.id < b.id;
                         });
        split(first, middle);
        split(middle, last);
    }
};

}  // namespace

void spread(std::span<SpreadItem> items, std::uint32_t leaves, Fill fill) noexcept {
    if (leaves > 0) Spread{items, leaves, fill}.split(0, leaves);
}

}  // namespace cdprep
