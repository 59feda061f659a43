// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "support/open_tiny.h"
#include "support/tiny_pieces.h"

#include "cdprep/pairs.h"
#include "walk/walked_trees.h"
#include "walk/workspace_storage.h"

namespace cdprep::test {

/// Two soups in pieces, and pairs of their leaves. The library assembles leaves of pieces in fewer
/// places than there are leaves. Here three leaves compete for each of a few places. Leaves of a
/// pair that waits for its test would be replaced by others if the library permitted it.
struct WaitingLeaves {
    OpenModel a;
    OpenModel b;
    std::vector<TrianglePair> leaves;
};

inline WaitingLeaves waiting_leaves(std::uint32_t seed, std::size_t pairs) {
    std::mt19937 random(seed);
    const auto soup = [&] {
        const TestMesh mesh = random_soup(random(), 4000, 0.5);
        return open_tiny(with_piece_tree(bake_tiny(mesh.positions, mesh.triangles)));
    };
    OpenModel a = soup();
    WaitingLeaves made = {std::move(a), soup(), std::vector<TrianglePair>(pairs)};
    const auto any_leaf = [&] { return random() % 6 + kernels::kLeafPlaces * (random() % 3); };
    for (TrianglePair& pair : made.leaves) {
        const auto leaf_a = any_leaf();
        pair = {static_cast<std::uint32_t>(leaf_a), static_cast<std::uint32_t>(any_leaf())};
    }
    return made;
}

/// Returns the triangle pairs found in pairs of leaves of pieces, tested `views` at a time.
inline std::vector<TrianglePair> pairs_in_leaves(const WaitingLeaves& waiting, std::size_t views,
                                                 Workspace& workspace) {
    const Model &a = waiting.a.model, &b = waiting.b.model;
    const PlacedBoxes placed = place_boxes(a, b, Placement::b_moves(Pose()));
    const PieceTrees trees(a, b, workspace.storage());
    LeafBatch batch(a, b, placed, workspace.storage());
    std::vector<TrianglePair> pairs;
    const auto found = [&](std::uint32_t at_a, std::uint32_t at_b, bool /*certain*/) {
        pairs.push_back({trees.triangle_a(at_a), trees.triangle_b(at_b)});
        return true;
    };
    const auto test = [&](const LeafView& in_a, const LeafView& in_b) {
        batch.add(in_a, in_b);
        return batch.size() < views || batch.flush(found);
    };
    for (const auto& [leaf_a, leaf_b] : waiting.leaves) {
        trees.each_pair(batch, leaf_a, leaf_b, test);
    }
    batch.flush(found);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace cdprep::test
