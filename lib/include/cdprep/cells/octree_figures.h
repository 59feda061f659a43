// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"

namespace cdprep {

/// Figures that describe an octree of either kind (format/octree.h): its size, and the quality of
/// its division.
struct OctreeFigures {
    std::uint64_t triangles = 0;       ///< of the model
    std::uint64_t nodes = 0;           ///< stored cells: those that some triangle touches
    std::uint64_t leaves = 0;          ///< nodes that are not divided
    std::uint64_t empty_children = 0;  ///< eight per divided node, less the stored ones
    std::uint64_t references = 0;      ///< in the lists of all leaves
    std::uint64_t shared = 0;          ///< triangles that more than one leaf lists
    std::uint64_t largest_leaf = 0;    ///< references
    std::uint32_t deepest = 0;         ///< level of the deepest node; 0: the root
    std::uint64_t bytes = 0;           ///< of all its sections as stored
    std::uint64_t table_bytes = 0;     ///< the part of `bytes` for tables that find cells by key

    friend bool operator==(const OctreeFigures&, const OctreeFigures&) = default;
};

/// Returns the figures of a model's octree. All but `triangles` are 0 if the model was baked or
/// opened without an octree. Takes O(nodes + references) time.
[[nodiscard]] CDPREP_API OctreeFigures octree_figures(const Model& model) noexcept;

/// Returns the same figures for an octree in memory that was built over `triangle_count` triangles.
[[nodiscard]] CDPREP_API OctreeFigures octree_figures(const build::Octree& octree,
                                                      std::uint64_t triangle_count) noexcept;

/// Returns the same figures of an adaptive octree.
[[nodiscard]] CDPREP_API OctreeFigures adaptive_octree_figures(const Model& model) noexcept;
[[nodiscard]] CDPREP_API OctreeFigures
adaptive_octree_figures(const build::AdaptiveOctree& octree, std::uint64_t triangle_count) noexcept;

/// The treatment of empty children in seed_formula_bytes(). No triangle touches an empty child.
enum class EmptyChildren : std::uint8_t { counted, left_out };

/// Returns the size in bytes that the published implementation would need (docs/STUDIES.md). The
/// root takes 72, any other node 80, and a reference 4. It is not known whether that implementation
/// stored empty children. Returns 0 without nodes. The formula is that of "A comparative study of
/// implemented collision detection strategies".
[[nodiscard]] CDPREP_API std::uint64_t seed_formula_bytes(const OctreeFigures& figures,
                                                          EmptyChildren empty) noexcept;

}  // namespace cdprep
