// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/effects.h"
#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/format/section_set.h"
#include "cdprep/result.h"
#include "cli/command.h"
#include "decompose/enclose/hull_sections.h"
#include "text/structure_settings.h"

namespace cdprep::cli {

/// The options for convex hulls and enclosing parts. Parts are built if `parts` or `max_error` is
/// set.
struct HullChoice {
    std::uint32_t max_vertices = 0;        ///< of each; 0: any number, exact
    std::optional<std::size_t> parts;      ///< maximum number of parts that enclose the mesh
    std::optional<double> max_error = {};  ///< maximum distance that they stick out, model units

    [[nodiscard]] bool has_parts() const noexcept {
        return parts || max_error;
    }
};

/// The command-line arguments about structures.
struct StructureArguments {
    std::string list = {};  ///< --structures; empty: not given
    std::string preset = "tuned";
    bool is_preset_given = false;
    std::optional<std::uint32_t> octree_level = {};
    std::optional<std::uint32_t> octree_threshold = {};
    std::optional<std::uint32_t> tetra_level = {};
    std::optional<std::uint32_t> tetra_threshold = {};
    std::string split = {};            ///< empty: not given
    std::string octree_bounding = {};  ///< empty: not given
    std::string bounding = {};         ///< empty: not given
    HullChoice hulls = {};
};

/// Adds --structures and the options for building them.
void add_structure_options(const Command& command, StructureArguments& arguments);

/// The structures that a bake builds, and their options.
struct StructureChoice {
    std::vector<std::string> names;  ///< those that queries can use, as --structures spells them
    format::SectionSet sections;     ///< the sections that store them
    build::OctreeOptions octree;     ///< for the hashed octree too
    build::AdaptiveOctreeOptions adaptive_octree;
    build::TetraTreeOptions tetra_tree;
    HullChoice hulls;
    std::vector<report::StructureSettings> settings;  ///< these decide the bytes of each structure

    [[nodiscard]] bool has_octree() const noexcept {
        return sections.contains(format::SectionId::octree_nodes);
    }
    [[nodiscard]] bool has_adaptive_octree() const noexcept {
        return sections.contains(format::SectionId::adaptive_octree_nodes);
    }
    /// Returns whether the cells of the octree store bounding boxes.
    [[nodiscard]] bool octree_boxes() const noexcept {
        return sections.contains(format::SectionId::octree_boxes);
    }
    [[nodiscard]] bool adaptive_octree_boxes() const noexcept {
        return sections.contains(format::SectionId::adaptive_octree_boxes);
    }
    [[nodiscard]] bool has_tetra_tree() const noexcept {
        return sections.contains(format::SectionId::tetra_nodes);
    }
    [[nodiscard]] bool has_hulls() const noexcept {
        return sections.contains(format::SectionId::hulls);
    }
};

/// Returns the structures that --structures lists. Without this option, returns every structure if
/// the effects are "all", else none. The effect `inaccessible` adds the tetra-tree if it is named.
/// Fails with bad_argument on an unknown name, or on an option of a structure that is not built.
[[nodiscard]] Result<StructureChoice> choose_structures(const StructureArguments& arguments,
                                                        const Effects& effects);

/// The structures that were built; those that were not chosen are empty.
struct Structures {
    build::Octree octree;
    build::AdaptiveOctree adaptive_octree;
    build::TetraTree tetra_tree;
    convex::HullSections hulls;
};

}  // namespace cdprep::cli
