// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/structures.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "cdprep/cells/structure_presets.h"
#include "cdprep/format/limits.h"
#include "command_line/command_line.h"
#include "hull/enclosing_hull.h"
#include "text/nearest_word.h"
#include "text/structure_name.h"

namespace cdprep::cli {
namespace {

const report::StructureName* find_baked(const std::string& name) {
    const auto* at = std::find_if(
        report::kStructureNames.begin(), report::kStructureNames.end(),
        [&](const report::StructureName& known) { return known.is_baked && name == known.name; });
    return at == report::kStructureNames.end() ? nullptr : at;
}

/// Returns the sections that a baked structure needs.
format::SectionSet needed_by(Structure structure) {
    return find_needs(ask_of(structure))->needed;
}

std::vector<std::string> baked_names() {
    std::vector<std::string> names;
    for (const report::StructureName& known : report::kStructureNames) {
        if (known.is_baked) names.emplace_back(known.name);
    }
    names.emplace_back(report::kHullName);
    return names;
}

/// Returns the words that --structures may hold.
std::vector<std::string> listed_words() {
    std::vector<std::string> words = baked_names();
    words.insert(words.end(), {"all", "none"});
    return words;
}

Error unknown_structure(const std::string& name) {
    std::string message = "--structures: unknown structure '" + name + "'. Choose from ";
    for (const std::string& known : baked_names()) message += known + ", ";
    return {ErrorCode::bad_argument,
            message + "all or none." + report::suggestion(name, baked_names())};
}

/// Returns the structures that a comma-separated list names.
Result<std::vector<std::string>> parse_list(const std::string& list) {
    if (list == "none") return std::vector<std::string>{};
    std::vector<std::string> names;
    std::istringstream stream(list);
    for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
    if (std::find(names.begin(), names.end(), "all") != names.end()) {
        std::erase(names, "all");
        for (const std::string& name : baked_names()) names.push_back(name);
    }
    for (const std::string& name : names) {
        const bool is_known = name == report::kHullName || find_baked(name) != nullptr;
        if (!is_known) return unknown_structure(name);
    }
    return names;
}

/// Returns an error if an option is given that has no effect: the user expects it to have one.
std::optional<Error> find_idle_option(const StructureArguments& arguments,
                                      const StructureChoice& choice) {
    const bool has_some_octree = choice.has_octree() || choice.has_adaptive_octree();
    struct Use {
        const char* option;
        bool is_given;
        bool is_used;
        const char* user;
    };
    const bool has_cells = has_some_octree || choice.has_tetra_tree();
    const std::array<Use, 11> uses = {{
        {"--structure-preset", arguments.is_preset_given, has_cells, "octree or tetra-tree"},
        {"--octree-level", arguments.octree_level.has_value(), has_some_octree, "octree"},
        {"--octree-threshold", arguments.octree_threshold.has_value(), has_some_octree, "octree"},
        {"--tetra-level", arguments.tetra_level.has_value(), choice.has_tetra_tree(), "tetra-tree"},
        {"--tetra-threshold", arguments.tetra_threshold.has_value(), choice.has_tetra_tree(),
         "tetra-tree"},
        {"--split", !arguments.split.empty(), choice.has_adaptive_octree(), "octree-adaptive"},
        {"--octree-bounding", !arguments.octree_bounding.empty(), has_some_octree, "octree"},
        {"--bounding", !arguments.bounding.empty(), choice.has_tetra_tree(), "tetra-tree"},
        {"--hull-vertices", arguments.hulls.max_vertices > 0, choice.has_hulls(), "hull"},
        {"--parts", arguments.hulls.parts.has_value(), choice.has_hulls(), "hull"},
        {"--max-error", arguments.hulls.max_error.has_value(), choice.has_hulls(), "hull"},
    }};
    for (const Use& use : uses) {
        if (!use.is_given || use.is_used) continue;
        return Error{ErrorCode::bad_argument, std::string(use.option) + " has no effect: add " +
                                                  use.user +
                                                  " to --structures, or remove the option."};
    }
    return std::nullopt;
}

/// Returns the preset with this name. The command line admits no unknown name.
const build::StructurePreset& preset_named(const std::string& name) {
    return *std::find_if(build::kStructurePresets.begin(), build::kStructurePresets.end(),
                         [&](const build::StructurePreset& preset) { return name == preset.name; });
}

template <class Options>
void limit(Options& options, const build::TreeLimits& preset,
           const std::optional<std::uint32_t>& level,
           const std::optional<std::uint32_t>& threshold) {
    options.level = level.value_or(preset.level);
    options.threshold = threshold.value_or(preset.threshold);
}

std::vector<report::StructureSettings> settings_of(const StructureChoice& choice) {
    std::vector<report::StructureSettings> settings;
    for (const std::string& name : choice.names) {
        if (name == report::kHullName) continue;  // nothing about it is chosen
        const Structure structure = find_baked(name)->structure;
        if (structure == Structure::adaptive_octree) {
            settings.push_back(
                {structure,
                 choice.adaptive_octree.level,
                 choice.adaptive_octree.threshold,
                 {{"split", report::split_name(choice.adaptive_octree.rule)},
                  {"bounding", report::bounding_name(choice.adaptive_octree_boxes())}}});
        } else if (structure == Structure::tetra_tree) {
            settings.push_back({structure,
                                choice.tetra_tree.level,
                                choice.tetra_tree.threshold,
                                {{"bounding", report::bounding_name(choice.tetra_tree.bounding)}}});
        } else {
            settings.push_back({structure,
                                choice.octree.level,
                                choice.octree.threshold,
                                {{"bounding", report::bounding_name(choice.octree_boxes())}}});
        }
    }
    return settings;
}

}  // namespace

Result<StructureChoice> choose_structures(const StructureArguments& arguments,
                                          const Effects& effects) {
    const std::string unless_said = effects.all ? "all" : "none";
    Result<std::vector<std::string>> names =
        parse_list(arguments.list.empty() ? unless_said : arguments.list);
    if (!names) return names.error();
    StructureChoice choice;
    // `inaccessible` is the one effect that needs a structure. "all" does not add it here.
    if (!effects.all && contains(effects.asks, Ask::inaccessible)) {
        choice.sections.insert(needed_by(Structure::tetra_tree));
    }
    for (const std::string& name : names.value()) {
        choice.sections.insert(find_needs(std::string_view(name))->needed);
    }
    for (const report::StructureName& known : report::kStructureNames) {
        // The hashed octree brings the octree's own sections.
        if (known.is_baked && choice.sections.contains(needed_by(known.structure))) {
            choice.names.emplace_back(known.name);
        }
    }
    if (choice.has_hulls()) choice.names.emplace_back(report::kHullName);
    choice.hulls = arguments.hulls;
    if (const auto error = find_idle_option(arguments, choice)) return *error;

    choice.octree.hashed = choice.sections.contains(format::SectionId::octree_leaf_codes);
    const build::StructurePreset& preset = preset_named(arguments.preset);
    limit(choice.octree, choice.octree.hashed ? preset.hashed_octree : preset.octree,
          arguments.octree_level, arguments.octree_threshold);
    limit(choice.adaptive_octree, preset.adaptive_octree, arguments.octree_level,
          arguments.octree_threshold);
    limit(choice.tetra_tree, preset.tetra_tree, arguments.tetra_level, arguments.tetra_threshold);
    choice.adaptive_octree.rule = arguments.split.empty()     ? preset.split
                                  : arguments.split == "area" ? format::SplitRule::surface_area
                                                              : format::SplitRule::median;
    const bool has_boxes =
        arguments.octree_bounding.empty() ? preset.boxes : arguments.octree_bounding == "boxes";
    if (has_boxes && choice.has_octree()) choice.sections.insert(format::SectionId::octree_boxes);
    if (has_boxes && choice.has_adaptive_octree()) {
        choice.sections.insert(format::SectionId::adaptive_octree_boxes);
    }
    choice.tetra_tree.bounding = preset.bounding;
    for (const auto bounding : {format::TetraBounding::tetra, format::TetraBounding::caps,
                                format::TetraBounding::boxes}) {
        if (arguments.bounding == report::bounding_name(bounding)) {
            choice.tetra_tree.bounding = bounding;
        }
    }
    if (choice.has_tetra_tree() && choice.tetra_tree.bounding == format::TetraBounding::boxes) {
        choice.sections.insert(find_needs(Ask::tetra_tree)->used);
    }
    choice.settings = settings_of(choice);
    return choice;
}

namespace {

constexpr const char* kGroup = "Structures";

/// Adds the options for splitting and bounding cells.
void add_cell_rules(const Command& command, StructureArguments& arguments) {
    command
        .add_option("--split", arguments.split,
                    "Split planes of octree-adaptive. median: at the median of the centres of the "
                    "triangles' boxes. area: the one of 15 planes with the least sum, over both "
                    "sides, of surface area times number of triangles. Default: set by the preset")
        .type_name("RULE")
        .check(one_of({"median", "area"}))
        .group(kGroup);
    command
        .add_option("--octree-bounding", arguments.octree_bounding,
                    "Bounds of an octree cell's triangles. boxes: their bounding box; cells: the "
                    "cell itself. Default: set by the preset")
        .type_name("BOUNDS")
        .check(one_of({"boxes", "cells"}))
        .group(kGroup);
    command
        .add_option("--bounding", arguments.bounding,
                    "Bounds of a tetra-tree cone's triangles. boxes: bounding boxes, the fastest. "
                    "caps: from the nearest to the farthest point. tetra: from the centre to the "
                    "farthest point. Default: set by the preset")
        .type_name("BOUNDS")
        .check(one_of({"boxes", "caps", "tetra"}))
        .group(kGroup);
}

void add_hull_options(const Command& command, HullChoice& hulls) {
    command
        .add_option("--hull-vertices", hulls.max_vertices,
                    "For --structures hull: maximum number of vertices of each hull and part. "
                    "Hulls then enclose the exact ones")
        .check(whole_from(convex::kFewestEnclosingVertices, format::kMaxTriangles))
        .group(kGroup);
    command
        .add_option("--parts", hulls.parts,
                    "For --structures hull: also bake at most N convex parts that together "
                    "enclose the mesh")
        .check(whole_from(1))
        .group(kGroup);
    command
        .add_option("--max-error", hulls.max_error,
                    "For --structures hull: also bake enclosing convex parts that stick out by at "
                    "most this distance, in model units")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .group(kGroup);
}

}  // namespace

void add_structure_options(const Command& command, StructureArguments& arguments) {
    command
        .add_option("--structures", arguments.list,
                    "Comma-separated structures for 'cdprep query --structure'. Default: all if "
                    "--effects includes all, else none. --effects inaccessible adds tetra-tree")
        .type_name("LIST")
        .check(list_of(listed_words()))
        .group(kGroup);
    command
        .add_option("--structure-preset", arguments.preset,
                    "Fineness of octrees and tetra-trees. tuned: for speed; paper: 512 cells, as "
                    "in published studies")
        .type_name("PRESET")
        .check(one_of({"tuned", "paper"}))
        .show_default()
        .group(kGroup);
    const auto number = [&](const char* name, std::optional<std::uint32_t>& value,
                            std::uint32_t least, std::uint32_t most, const char* description) {
        command.add_option(name, value, description).check(whole_from(least, most)).group(kGroup);
    };
    number("--octree-level", arguments.octree_level, 0, format::kOctreeBits,
           "Maximum depth of octrees. Default: set by the preset");
    number("--octree-threshold", arguments.octree_threshold, 1, format::kMaxTriangles,
           "Octrees: do not divide a cell with fewer triangles. Default: set by the preset");
    number("--tetra-level", arguments.tetra_level, 0, format::kMaxTetraLevel,
           "Maximum depth of the tetra-tree. Default: set by the preset");
    number("--tetra-threshold", arguments.tetra_threshold, 1, format::kMaxTriangles,
           "Tetra-tree: do not split a cone with fewer triangles. Default: set by the preset");
    add_cell_rules(command, arguments);
    add_hull_options(command, arguments.hulls);
}

}  // namespace cdprep::cli
