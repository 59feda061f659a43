// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/cells/octree_figures.h"
#include "cdprep/cells/tetra_figures.h"
#include "cdprep/model.h"
#include "text/structure_settings.h"

namespace cdprep::report {

/// How well the cones of a tetra-tree suit its mesh.
struct ConeFigures {
    std::string centre;           ///< inside, outside or on the surface
    std::uint64_t at_centre = 0;  ///< triangles that hold the centre
    double mean_layers = 0;       ///< as TetraFigures
    std::uint64_t most_layers = 0;
    std::uint64_t in_many = 0;  ///< triangles that more than 8 leaves list
};

/// A structure that a file holds besides the hierarchy of boxes, and what it costs.
struct StructureReport {
    StructureSettings settings;
    std::uint64_t triangles = 0;  ///< of the model
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    std::uint32_t deepest = 0;  ///< level of the deepest node
    std::uint64_t references = 0;
    std::uint64_t shared = 0;        ///< triangles that more than one leaf lists
    std::uint64_t largest_leaf = 0;  ///< references
    /// Of all sections that questions through it read; those of the octree count for the
    /// hashed octree too.
    std::uint64_t bytes = 0;
    std::optional<ConeFigures> cones;  ///< tetra-tree only
};

/// `which` is the octree, or the hashed one that finds its cells. `has_boxes`: around what the
/// cells hold.
[[nodiscard]] StructureReport report_of(Structure which, const format::OctreeGrid& grid,
                                        const OctreeFigures& figures, bool has_boxes);
[[nodiscard]] StructureReport report_of(const format::AdaptiveOctree& tree,
                                        const OctreeFigures& figures, bool has_boxes);
[[nodiscard]] StructureReport report_of(const format::TetraTree& tree, const TetraFigures& figures);

/// Of each structure of an open model.
[[nodiscard]] std::vector<StructureReport> structure_reports(const Model& model);

/// An object by name: {"octree": {"level": 9, ...}}.
[[nodiscard]] nlohmann::ordered_json structures_json(const std::vector<StructureReport>& reports);

/// A line each, for a person, indented.
[[nodiscard]] std::string structures_text(const std::vector<StructureReport>& reports);

}  // namespace cdprep::report
