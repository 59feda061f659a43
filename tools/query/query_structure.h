// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cdprep/advanced/structure.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/pairs.h"
#include "cdprep/result.h"
#include "cli/command.h"

namespace cdprep::cli {

/// The command-line arguments about the structure that answers a query; empty: not given.
struct StructureWords {
    std::string structure = "bvh";
    std::string leaf_test;
    std::string descent;
    std::string search;
};

/// Returns the names of structures, as --structure spells them.
[[nodiscard]] std::vector<std::string> names_of(std::span<const Structure> structures);

/// Adds --structure, which accepts the given names.
void add_structure(const Command& command, StructureWords& words,
                   const std::vector<std::string>& names, const char* description);

/// Adds --leaf-test, --descent and --search, for queries about two models.
void add_structure_steps(const Command& command, StructureWords& words);

/// Adds --as, the meaning of a model: "surface" or "solid".
void add_body(const Command& command, std::string& word);

/// Returns the body that a word of --as names.
[[nodiscard]] Body parse_body(const std::string& word) noexcept;

/// Returns the structure and its options. Fails with bad_argument if an option does not apply to
/// the structure. Requires a name of a Structure.
[[nodiscard]] Result<StructureOptions> parse_structure(const StructureWords& words);

}  // namespace cdprep::cli
