// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "walk_pairs.h"

namespace cdprep {

/// Walks one hierarchy depth first: `enter(node, box)` tells whether a box of a
/// node is of interest, `leaf(index)` handles a leaf whose box was, and ends the
/// walk by returning false. Returns false when it did.
template <class Enter, class Leaf>
bool walk_model(const Model& model, Workspace::Storage& scratch, Enter&& enter,
                Leaf&& leaf) noexcept {
    const Tree tree(model);
    if (tree.triangles == 0) return true;
    std::size_t depth = 0;
    scratch.pending[depth++] = PendingPair{{tree.shape.levels, 0}, {0, 0}}.packed();
    while (depth > 0) {
        const TreePlace place = PendingPair::unpacked(scratch.pending[--depth]).a;
        if (place.height == 0) {
            if (!leaf(place.index)) return false;
            continue;
        }
        const TestedBoxes boxes = boxes_of(tree, place, true);
        for (std::uint32_t box = boxes.first; box < boxes.last; ++box) {
            if (!enter(*boxes.node, box)) continue;
            const TreePlace below{boxes.first_below.height, boxes.first_below.index + box};
            scratch.pending[depth++] = PendingPair{below, {0, 0}}.packed();
        }
    }
    return true;
}

}  // namespace cdprep
