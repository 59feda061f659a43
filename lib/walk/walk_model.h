// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>

#include "walk/walk_pairs.h"

namespace cdprep {

/// The boxes of a node that are of interest, and those of them that need no further test: bit sets.
struct BoxVerdict {
    unsigned near = 0;
    unsigned inside = 0;
};

/// The triangles below a place, in tree order.
struct TriangleRun {
    std::uint32_t first;
    std::uint32_t last;  ///< one past
};

inline TriangleRun triangles_below(const Tree& tree, const TreePlace& place) noexcept {
    assert(place.height <= tree.shape.levels);
    std::uint64_t size = format::kBvhWidth;
    for (std::uint32_t i = 0; i < place.height; ++i) size *= format::kBvhWidth;
    const std::uint64_t all = tree.triangles;
    return {static_cast<std::uint32_t>(std::min(place.index * size, all)),
            static_cast<std::uint32_t>(std::min((place.index + 1) * size, all))};
}

/// Walks one hierarchy depth first. `judge(node)` returns which of its boxes are near, and which of
/// these are inside. `some(run)` handles the triangles of a near leaf, `whole(run)` those of a box
/// inside. Stops and returns false when either returns false.
template <class Judge, class Some, class Whole>
bool walk_nodes(const Model& model, Workspace::Storage& scratch, Judge&& judge, Some&& some,
                Whole&& whole) noexcept {
    const Tree tree(model);
    if (tree.triangles == 0) return true;
    const bool has_gaps = !model.bvh().lanes.empty();
    std::size_t depth = 0;
    scratch.pending[depth++] = PendingPair{{tree.shape.levels, 0}, {0, 0}}.packed();
    while (depth > 0) {
        const TreePlace place = PendingPair::unpacked(scratch.pending[--depth]).a;
        if (place.height == 0) {
            if (!some(triangles_below(tree, place))) return false;
            continue;
        }
        const TestedBoxes boxes = boxes_of(tree, place, true);
        const format::BvhNode& node = tree.nodes[boxes.node];
        const BoxVerdict verdict = judge(node);
        assert(verdict.near <= 0xff && verdict.inside <= 0xff);
        const unsigned used = has_gaps ? chosen(boxes) & used_boxes(node) : chosen(boxes);
        for (unsigned bits = verdict.near & used; bits != 0; bits &= bits - 1) {
            const auto box = static_cast<std::uint32_t>(std::countr_zero(bits));
            const TreePlace below{boxes.first_below.height, boxes.first_below.index + box};
            if (((verdict.inside >> box) & 1) == 0) {
                assert(depth < scratch.pending.size());
                scratch.pending[depth++] = PendingPair{below, {0, 0}}.packed();
            } else if (!whole(triangles_below(tree, below))) {
                return false;
            }
        }
    }
    return true;
}

/// Walks one hierarchy depth first. `enter(node, box)` returns whether a box of a node is of
/// interest. `leaf(index)` handles a leaf whose box is. Stops and returns false when `leaf` returns
/// false.
template <class Enter, class Leaf>
bool walk_model(const Model& model, Workspace::Storage& scratch, Enter&& enter,
                Leaf&& leaf) noexcept {
    const auto judge = [&](const format::BvhNode& node) {
        BoxVerdict verdict;
        for (std::uint32_t box = 0; box < format::kBvhWidth; ++box) {
            if (enter(node, box)) verdict.near |= 1U << box;
        }
        return verdict;
    };
    const auto some = [&](const TriangleRun& run) { return leaf(run.first / format::kBvhWidth); };
    return walk_nodes(model, scratch, judge, some, [](const TriangleRun&) { return true; });
}

}  // namespace cdprep
