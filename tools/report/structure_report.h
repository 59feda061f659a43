// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cdprep/format/octree.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/model.h"
#include "report/structure_settings.h"

namespace cdprep::report {

/// How well the cones of a tetra-tree suit its mesh.
struct ConeFigures {
    double mean_layers = 0;          ///< of the leaves: how often rays from the centre cross it
    double most_layers = 0;          ///< of the worst leaf
    double share_in_many = 0;        ///< of the triangles: those listed in more than 8 leaves
    std::uint64_t at_centre = 0;     ///< triangles that hold the centre
    std::string centre = "outside";  ///< or inside, or on the surface
};

/// A structure that a file holds besides the hierarchy of boxes, and what it costs.
struct StructureReport {
    StructureSettings settings;
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    std::uint64_t references = 0;
    std::uint64_t largest_leaf = 0;      ///< references
    double references_per_triangle = 0;  ///< 0 without triangles
    /// Of all sections that questions through it read; those of the octree count for the
    /// hashed octree too.
    std::uint64_t bytes = 0;
    std::optional<ConeFigures> cones;  ///< tetra-tree only
};

/// The structures of an open model, or of a bake that is not written yet. Null: not there.
struct StructureViews {
    const format::OctreeGrid* octree = nullptr;
    std::span<const format::OctreeNode> octree_nodes;
    std::span<const std::uint32_t> octree_references;
    bool is_hashed = false;  ///< the tables that find the octree's cells are there too
    const format::AdaptiveOctree* adaptive_octree = nullptr;
    std::span<const format::AdaptiveOctreeNode> adaptive_octree_nodes;
    std::span<const std::uint32_t> adaptive_octree_references;
    const format::TetraTree* tetra_tree = nullptr;
    std::span<const format::TetraNode> tetra_nodes;
    std::span<const std::uint32_t> tetra_references;
};
[[nodiscard]] StructureViews views_of(const Model& model);

/// A section that a file has, and its size.
struct SectionBytes {
    SectionId id;
    std::uint64_t bytes;
};

/// Of each structure that is there.
[[nodiscard]] std::vector<StructureReport> structure_reports(
    const StructureViews& views, std::uint64_t triangle_count,
    std::span<const SectionBytes> sections);

/// An object by name: {"octree": {"level": 9, ...}}.
[[nodiscard]] nlohmann::ordered_json structures_json(const std::vector<StructureReport>& reports);

/// A line each, for a person, indented.
[[nodiscard]] std::string structures_text(const std::vector<StructureReport>& reports);

}  // namespace cdprep::report
