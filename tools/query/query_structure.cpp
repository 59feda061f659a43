// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/query_structure.h"

#include <algorithm>
#include <optional>

#include "cdprep/cells/overlap_through.h"
#include "command_line/command_line.h"
#include "text/structure_name.h"

namespace cdprep::cli {
namespace {

Structure structure_named(const std::string& name) {
    return std::ranges::find_if(
               report::kStructureNames,
               [&](const report::StructureName& known) { return known.name == name; })
        ->structure;
}

/// Returns an error if an option is given that has no effect: the user expects it to have one.
std::optional<Error> find_idle_option(const StructureWords& words, Structure structure) {
    const auto idle = [&](const char* option, const char* user) {
        return Error{ErrorCode::bad_argument, std::string(option) + " is for " + user +
                                                  ", but --structure is " +
                                                  report::structure_name(structure) + "."};
    };
    const bool is_hierarchy = structure == Structure::bvh || structure == Structure::pieces;
    if (!words.leaf_test.empty() && is_hierarchy) {
        return idle("--leaf-test", "octree, octree-adaptive, hashed-octree and tetra-tree");
    }
    if (!words.descent.empty() && (is_hierarchy || structure == Structure::hashed_octree)) {
        return idle("--descent", "octree, octree-adaptive and tetra-tree");
    }
    if (!words.search.empty() && structure != Structure::hashed_octree) {
        return idle("--search", "hashed-octree and hashed-octree-literal");
    }
    return std::nullopt;
}

}  // namespace

void add_body(const Command& command, std::string& word) {
    command
        .add_option(
            "--as", word,
            "Points that belong to a model. surface: its triangles; solid: also what they enclose")
        .type_name("BODY")
        .check(one_of({"surface", "solid"}))
        .show_default()
        .group("Query");
}

Body parse_body(const std::string& word) noexcept {
    return word == "solid" ? Body::solid : Body::surface;
}

Result<StructureOptions> parse_structure(const StructureWords& words) {
    StructureOptions options;
    options.structure = structure_named(words.structure);
    if (const auto error = find_idle_option(words, options.structure)) return *error;
    if (words.leaf_test == "feito") options.leaf_test = LeafTest::feito_torres;
    if (words.descent == "a-first") options.descent = Descent::a_first;
    if (words.descent == "b-first") options.descent = Descent::b_first;
    if (words.descent == "larger") options.descent = Descent::larger;
    if (words.search == "modulus") options.search = CellSearch::modulus;
    if (words.search == "sorted") options.search = CellSearch::sorted;
    return options;
}

std::vector<std::string> names_of(std::span<const Structure> structures) {
    std::vector<std::string> names;
    for (const Structure structure : structures) {
        names.emplace_back(report::structure_name(structure));
    }
    return names;
}

void add_structure(const Command& command, StructureWords& words,
                   const std::vector<std::string>& names, const char* description) {
    command.add_option("--structure", words.structure, description)
        .type_name("STRUCTURE")
        .check(one_of(names))
        .show_default()
        .group("Structure");
}

void add_structure_steps(const Command& command, StructureWords& words) {
    command
        .add_option("--leaf-test", words.leaf_test,
                    "Exact test of two triangles, for octree, octree-adaptive, hashed-octree and "
                    "tetra-tree. guigue-devillers: signs against planes (default). feito: six "
                    "edges against triangles. Both give the same answers")
        .type_name("TEST")
        .check(one_of({"guigue-devillers", "feito"}))
        .group("Structure");
    command
        .add_option(
            "--descent", words.descent,
            "Cell to divide first in octree, octree-adaptive and tetra-tree: the larger one, A's, "
            "B's, or both (default). Answers do not change")
        .type_name("ORDER")
        .check(one_of({"larger", "a-first", "b-first", "both"}))
        .group("Structure");
    command
        .add_option("--search", words.search,
                    "Method to find a cell of hashed-octree. sorted: binary search of sorted "
                    "leaves. modulus: hash by the key's remainder. mixed: hash by a mixed key "
                    "(default). Answers do not change")
        .type_name("SEARCH")
        .check(one_of({"sorted", "modulus", "mixed"}))
        .group("Structure");
}

}  // namespace cdprep::cli
