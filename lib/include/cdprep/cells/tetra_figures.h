// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"

namespace cdprep {

/// Figures that describe a tetra-tree (format/tetra_tree.h): its size, and how well its cones
/// divide the model. Layers are the triangles that a ray from the centre crosses; a star-shaped
/// model has one. Avoid a tetra-tree if there are more than about four layers, or if the centre is
/// outside or near the surface. Triangles that contain the centre touch every cone. Figures of
/// cones and layers ignore them.
struct TetraFigures {
    std::uint64_t triangles = 0;     ///< of the model
    std::uint64_t nodes = 0;         ///< stored cones: those that some triangle touches
    std::uint64_t leaves = 0;        ///< nodes that are not split
    std::uint64_t empty_cones = 0;   ///< octants and children that no triangle touches
    std::uint64_t references = 0;    ///< of all leaves, and triangles that contain the centre
    std::uint64_t centre_count = 0;  ///< triangles that contain the centre
    std::uint64_t shared = 0;        ///< triangles that more than one leaf lists
    std::uint64_t in_many = 0;       ///< triangles that more than eight leaves list
    std::uint64_t largest_leaf = 0;  ///< references
    std::uint32_t deepest = 0;       ///< splits above the deepest node
    /// The mean over the leaves of the number of triangles that a ray crosses. The ray runs from
    /// the centre through the middle of the leaf's generators. The count is exact. If the ray hits
    /// an edge, only the triangle on one side counts.
    double mean_layers = 0;
    std::uint64_t most_layers = 0;
    bool centre_inside = false;
    std::uint64_t bytes = 0;  ///< of all its sections as stored

    friend bool operator==(const TetraFigures&, const TetraFigures&) = default;
};

/// Returns the figures of a model's tetra-tree. All but `triangles` are 0 if the model was baked or
/// opened without a tetra-tree. Layers are 0 if the model was opened without positions or without
/// triangles. Takes O(nodes + references) time, tens of nanoseconds per reference. Allocates four
/// bytes per triangle.
[[nodiscard]] CDPREP_API TetraFigures tetra_figures(const Model& model);

/// Returns the same figures for a tetra-tree in memory that was built over these triangles.
[[nodiscard]] CDPREP_API TetraFigures tetra_figures(const build::TetraTree& tree,
                                                    std::span<const format::Double3> positions,
                                                    std::span<const format::Triangle> triangles);

/// Returns the size in bytes that the published implementation would need (docs/STUDIES.md). The
/// root takes 340, any other node 88, even an empty one, and a reference 4. Returns 0 without
/// nodes. The formula is that of "A comparative study of implemented collision detection
/// strategies".
[[nodiscard]] CDPREP_API std::uint64_t seed_formula_bytes(const TetraFigures& figures) noexcept;

}  // namespace cdprep
