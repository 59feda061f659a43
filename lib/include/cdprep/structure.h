// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/ask.h"

namespace cdprep {

/// Through which of a file's structures a question is answered. The answer is the same
/// through each, bit for bit, but for hashed_octree_literal.
enum class Structure : std::uint8_t {
    bvh,              ///< the hierarchy of boxes: the fastest about two models
    octree,           ///< both models' octrees, side by side
    adaptive_octree,  ///< both models' octrees with split points of their own
    /// One model's octree by its keys, for those triangles of the other that may collide: the
    /// talk's algorithm, repaired. Finds cells that boxes around triangles overlap.
    hashed_octree,
    /// The talk's algorithm to the letter: finds cells that a triangle's corners lie in,
    /// so it misses pairs. For studies.
    hashed_octree_literal,
    tetra_tree,  ///< both models' tetra-trees, side by side; the fastest about points
    pieces,      ///< both models' hierarchies over convex pieces of their surfaces
};

/// Which exact test decides about two triangles. They agree always.
enum class LeafTest : std::uint8_t {
    guigue_devillers,  ///< signs of planes, then of at most two edges
    feito_torres,      ///< six segments against triangles, as in the paper
};

/// What a pair of nodes that may overlap is replaced by.
enum class Descent : std::uint8_t {
    larger,   ///< the children of the larger, by size
    a_first,  ///< A's children against B, until A is a leaf
    b_first,  ///< A against B's children, until B is a leaf
    both,     ///< all children of A against all of B
};

/// How the hashed octree finds the cell of a key.
enum class CellSearch : std::uint8_t {
    sorted,   ///< leaves sorted by key, with a top table
    modulus,  ///< chained table, slot by the key's last bits, from the deepest level up
    mixed,    ///< the same, slot by a mixed key
};

struct StructureOptions {
    Structure structure = Structure::bvh;
    LeafTest leaf_test = LeafTest::guigue_devillers;
    Descent descent = Descent::both;
    CellSearch search = CellSearch::mixed;
};

/// Returns the bit of Ask that a question through a structure needs besides its own; nothing for
/// Structure::bvh.
[[nodiscard]] Ask ask_of(Structure structure) noexcept;

}  // namespace cdprep
