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

/// Figures that show how well the cones of a tetra-tree suit its mesh.
struct ConeFigures {
    std::string centre;           ///< inside, outside or on the surface
    std::uint64_t at_centre = 0;  ///< triangles that contain the centre
    double mean_layers = 0;       ///< as in TetraFigures
    std::uint64_t most_layers = 0;
    std::uint64_t in_many = 0;  ///< triangles that more than 8 leaves list
};

/// A structure that a file holds besides the BVH, and its size.
struct StructureReport {
    StructureSettings settings;
    std::uint64_t triangles = 0;  ///< of the model
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    std::uint32_t deepest = 0;  ///< level of the deepest node
    std::uint64_t references = 0;
    std::uint64_t shared = 0;        ///< triangles that more than one leaf lists
    std::uint64_t largest_leaf = 0;  ///< references
    /// The bytes of all sections that queries through the structure read. Those of the octree
    /// count for the hashed octree too.
    std::uint64_t bytes = 0;
    std::optional<ConeFigures> cones;  ///< tetra-tree only
};

/// Returns the report of a structure. `which` is the octree, or the hashed octree over the same
/// cells. `has_boxes` states that boxes bound the triangles in each cell.
[[nodiscard]] StructureReport report_of(Structure which, const format::OctreeGrid& grid,
                                        const OctreeFigures& figures, bool has_boxes);
[[nodiscard]] StructureReport report_of(const format::AdaptiveOctree& tree,
                                        const OctreeFigures& figures, bool has_boxes);
[[nodiscard]] StructureReport report_of(const format::TetraTree& tree, const TetraFigures& figures);

/// Returns the report of each structure of an open model.
[[nodiscard]] std::vector<StructureReport> structure_reports(const Model& model);

/// Returns an object with one member per structure: {"octree": {"level": 9, ...}}.
[[nodiscard]] nlohmann::ordered_json structures_json(const std::vector<StructureReport>& reports);

/// Returns one indented line per structure, for people.
[[nodiscard]] std::string structures_text(const std::vector<StructureReport>& reports);

}  // namespace cdprep::report
