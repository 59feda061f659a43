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

/// How convex hulls are built.
struct HullChoice {
    std::uint32_t max_vertices = 0;        ///< of each; 0: any number, exact
    std::optional<std::size_t> parts;      ///< at most so many enclose the mesh; else none,
    std::optional<double> max_error = {};  ///< unless they may stick out this far, model units

    [[nodiscard]] bool has_parts() const noexcept {
        return parts || max_error;
    }
};

/// What the command line says of structures.
struct StructureArguments {
    std::string list = {};  ///< --structures; empty: not given
    std::string preset = "tuned";
    std::optional<std::uint32_t> octree_level = {};
    std::optional<std::uint32_t> octree_threshold = {};
    std::optional<std::uint32_t> tetra_level = {};
    std::optional<std::uint32_t> tetra_threshold = {};
    std::string split = {};            ///< empty: not given
    std::string octree_bounding = {};  ///< empty: not given
    std::string bounding = {};         ///< empty: not given
    HullChoice hulls = {};
};

/// Adds --structures and the options that say how they are built.
void add_structure_options(const Command& command, StructureArguments& arguments);

/// The structures that a bake builds, and how.
struct StructureChoice {
    std::vector<std::string> names;  ///< those that can be asked, as --structures spells them
    format::SectionSet sections;     ///< what they are stored in
    build::OctreeOptions octree;     ///< of the hashed octree too
    build::AdaptiveOctreeOptions adaptive_octree;
    build::TetraTreeOptions tetra_tree;
    HullChoice hulls;
    std::vector<report::StructureSettings> settings;  ///< that decide the bytes of each of `names`

    [[nodiscard]] bool has_octree() const noexcept {
        return sections.contains(format::SectionId::octree_nodes);
    }
    [[nodiscard]] bool has_adaptive_octree() const noexcept {
        return sections.contains(format::SectionId::adaptive_octree_nodes);
    }
    /// Whether their cells get boxes.
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

/// Decides what is built: what --structures lists; without it every structure for all
/// effects, none otherwise. Fails with bad_argument on a name that is unknown, and on
/// options of a structure that is not built.
[[nodiscard]] Result<StructureChoice> choose_structures(const StructureArguments& arguments,
                                                        const Effects& effects);

/// What was built; empty where it was not asked for.
struct Structures {
    build::Octree octree;
    build::AdaptiveOctree adaptive_octree;
    build::TetraTree tetra_tree;
    convex::HullSections hulls;
};

}  // namespace cdprep::cli
