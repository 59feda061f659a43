// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/model.h"

namespace cdprep {

/// Figures that describe an octree of either kind (format/octree.h): its size, and how well
/// it divides.
struct OctreeFigures {
    std::uint64_t triangles = 0;       ///< of the model
    std::uint64_t nodes = 0;           ///< cells that some triangle touches: those stored
    std::uint64_t leaves = 0;          ///< of them, those that are not divided
    std::uint64_t empty_children = 0;  ///< of the eight of each divided node, those not there
    std::uint64_t references = 0;      ///< of all leaves
    std::uint64_t shared = 0;          ///< triangles that more than one leaf lists
    std::uint64_t largest_leaf = 0;    ///< references
    std::uint32_t deepest = 0;         ///< level of the deepest node; 0: the root
    std::uint64_t bytes = 0;           ///< of all its sections as stored
    std::uint64_t table_bytes = 0;     ///< of `bytes`, what finds cells by their keys

    friend bool operator==(const OctreeFigures&, const OctreeFigures&) = default;
};

/// The figures of a model's octree; all but `triangles` are 0 when it was baked without.
/// O(nodes + references).
[[nodiscard]] OctreeFigures octree_figures(const Model& model) noexcept;

/// The same of a tree over so many triangles that stands in no file.
[[nodiscard]] OctreeFigures octree_figures(const build::Octree& octree,
                                           std::uint64_t triangle_count) noexcept;

/// The same of an octree with split points of its own.
[[nodiscard]] OctreeFigures adaptive_octree_figures(const Model& model) noexcept;
[[nodiscard]] OctreeFigures adaptive_octree_figures(const build::AdaptiveOctree& octree,
                                                    std::uint64_t triangle_count) noexcept;

/// Whether a node has a record for every child, or for those alone that triangles touch.
enum class EmptyChildren : std::uint8_t { counted, left_out };

/// What the published implementation would take: 72 bytes for the root, 80 for any other
/// node, 4 for a reference. Which children it stored is not known. 0 without nodes.
[[nodiscard]] std::uint64_t seed_formula_bytes(const OctreeFigures& figures,
                                               EmptyChildren empty) noexcept;

}  // namespace cdprep
