// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/model.h"

namespace cdprep {

/// Figures that describe a tetra-tree (format/tetra_tree.h): its size, and how well its
/// cones divide this shape. A star-shaped one has one layer; with more than about four,
/// or the centre outside or near the surface, cones are the wrong tool.
struct TetraFigures {
    std::uint64_t triangles = 0;     ///< of the model
    std::uint64_t nodes = 0;         ///< cones that some triangle touches: those stored
    std::uint64_t leaves = 0;        ///< of them, those that are not split
    std::uint64_t empty_cones = 0;   ///< octants and children that no triangle touches
    std::uint64_t references = 0;    ///< of all leaves, and triangles that hold the centre
    std::uint64_t centre_count = 0;  ///< triangles that hold the centre
    std::uint64_t shared = 0;        ///< triangles that more than one leaf lists
    std::uint64_t in_many = 0;       ///< triangles that more than eight leaves list
    std::uint64_t largest_leaf = 0;  ///< references
    std::uint32_t deepest = 0;       ///< splits above the deepest node
    /// Over the leaves: triangles that the ray from the centre through the middle of the
    /// leaf's generators crosses, counted exactly, each on one side of an edge alone.
    double mean_layers = 0;
    std::uint64_t most_layers = 0;
    bool centre_inside = false;
    std::uint64_t bytes = 0;  ///< of all its sections as stored

    friend bool operator==(const TetraFigures&, const TetraFigures&) = default;
};

/// The figures of a model's tetra-tree; all but `triangles` are 0 when it was baked without.
/// Layers are 0 of a model that was opened without positions and triangles. O(nodes +
/// references), tens of nanoseconds a reference; allocates four bytes a triangle.
[[nodiscard]] TetraFigures tetra_figures(const Model& model);

/// The same of a tree over these triangles that stands in no file.
[[nodiscard]] TetraFigures tetra_figures(const build::TetraTree& tree,
                                         std::span<const format::Double3> positions,
                                         std::span<const format::Triangle> triangles);

/// What the published implementation would take: 340 bytes for the root, 88 for any other
/// node, empty ones too, 4 for a reference. 0 without nodes.
[[nodiscard]] std::uint64_t seed_formula_bytes(const TetraFigures& figures) noexcept;

}  // namespace cdprep
