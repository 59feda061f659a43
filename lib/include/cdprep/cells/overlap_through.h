// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/pairs.h"

namespace cdprep {

// Variants of one search, for studies that compare them. All give the same answers. overlaps() and
// collide() use the defaults.

/// The exact test of two triangles. Both tests always give the same result.
enum class LeafTest : std::uint8_t {
    guigue_devillers,  ///< signs of planes, then of at most two edges (Guigue, Devillers 2003)
    feito_torres,      ///< each of the six edges against the other triangle
};

/// The pairs of nodes that replace a pair that may overlap.
enum class Descent : std::uint8_t {
    larger,   ///< the children of the larger node against the other
    a_first,  ///< A's children against B, until A is a leaf
    b_first,  ///< A against B's children, until B is a leaf
    both,     ///< all children of A against all of B
};

/// The way in which the hashed octree finds the cell of a key.
enum class CellSearch : std::uint8_t {
    sorted,   ///< leaves sorted by key, with a top table
    modulus,  ///< chained table, slot by the key's last bits, from the deepest level up
    mixed,    ///< the same, slot by a mixed key
};

/// A structure and the variant of the search through it.
struct StructureOptions {
    Structure structure = Structure::bvh;
    LeafTest leaf_test = LeafTest::guigue_devillers;
    Descent descent = Descent::both;
    CellSearch search = CellSearch::mixed;
};

/// Finds the same pairs as overlaps(), in the same order, by `through` instead of
/// pair.options.through. Slowest if triangles are larger than cells and thousands of pairs overlap.
/// The workspace then has no room to remember all pairs found. For each pair without room, the
/// search determines which of the cells that list the pair reports it.
///
/// Needs Ask::overlap and ask_of() the structure of both models. For octrees and tetra-trees, the
/// workspace must be made with cells(). Never allocates; takes some 20 KiB of stack.
[[nodiscard]] CDPREP_API std::size_t overlaps_through(const Pair& pair,
                                                      const StructureOptions& through,
                                                      Workspace& workspace,
                                                      std::span<TrianglePair> room) noexcept;

/// Returns whether any two triangles overlap; stops at the first pair found. Structure::bvh and
/// Structure::pieces use pair.cache. Needs Ask::collide and ask_of() the structure of both models.
[[nodiscard]] CDPREP_API bool any_overlap_through(const Pair& pair, const StructureOptions& through,
                                                  Workspace& workspace) noexcept;

}  // namespace cdprep
