// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "cdprep/advanced/structure.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/result.h"
#include "cli/command.h"

namespace cdprep::cli {

/// What the command line says of the structure through which a question is asked; empty:
/// not given.
struct StructureWords {
    std::string structure = "bvh";
    std::string leaf_test;
    std::string descent;
    std::string search;
};

/// Adds --structure; add_structure_steps() adds --leaf-test, --descent and --search, for
/// questions about two models.
void add_structure(const Command& command, StructureWords& words, const char* description);
void add_structure_steps(const Command& command, StructureWords& words);

/// Fails with bad_argument when the structure is none of those that serve the question,
/// and when an option says how to do what the structure does not do. `question` stands
/// in the sentence.
[[nodiscard]] Result<StructureOptions> parse_structure(const StructureWords& words,
                                                       const char* question,
                                                       std::span<const Structure> serving);

}  // namespace cdprep::cli
