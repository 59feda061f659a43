// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "walk/walk_pairs.h"

namespace cdprep {

/// Walks one hierarchy, smallest bound first among siblings. `bound(node, box)` returns a lower
/// bound for the contents of the box. `leaf(index)` handles a leaf and returns the bound beyond
/// which nothing is of interest any more.
template <class Bound, class Leaf>
void walk_ordered(const Model& model, Workspace::Storage& scratch, double limit, Bound&& bound,
                  Leaf&& leaf) noexcept {
    const Tree tree(model);
    if (tree.triangles == 0) return;
    const bool has_gaps = !model.bvh().lanes.empty();
    std::size_t depth = 0;
    scratch.bounded[depth++] = {0, tree.shape.levels, 0};
    while (depth > 0) {
        const BoundedPlace top = scratch.bounded[--depth];
        if (top.bound > limit) continue;
        if (top.height == 0) {
            limit = std::min(limit, leaf(top.index));
            continue;
        }
        const TestedBoxes boxes = boxes_of(tree, {top.height, top.index}, true);
        assert(depth + (boxes.last - boxes.first) <= scratch.bounded.size());
        const auto first = scratch.bounded.begin() + static_cast<std::ptrdiff_t>(depth);
        auto last = first;
        const format::BvhNode& node = tree.nodes[boxes.node];
        const unsigned used = has_gaps ? used_boxes(node) : 0xff;
        for (std::uint32_t box = boxes.first; box < boxes.last; ++box) {
            const double value = bound(node, box);
            if (value > limit || (used >> box & 1) == 0) continue;
            *last++ = {value, boxes.first_below.height, boxes.first_below.index + box};
        }
        std::sort(first, last, [](const BoundedPlace& a, const BoundedPlace& b) {
            return a.bound > b.bound;  // the last is taken first
        });
        depth += static_cast<std::size_t>(last - first);
    }
}

}  // namespace cdprep
