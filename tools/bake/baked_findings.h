// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"
#include "repair/repair.h"
#include "validate/validation_report.h"

namespace cdprep::cli {

/// Finds the defects of a mesh as it is baked: `soup`, each vertex at its position in `welded`.
/// The report's exit code is Exit::findings if a finding is a warning or an error. --strict
/// refuses such a mesh, and one whose search for crossings ended early. The report names no input.
[[nodiscard]] report::ValidationReport find_for_bake(const mesh::TriangleSoup& soup,
                                                     const mesh::Mesh& welded,
                                                     std::uint64_t max_pairs,
                                                     ParallelFor parallel_for);

/// Returns the number of rules that found a warning or an error.
[[nodiscard]] std::uint64_t count_warnings(const report::ValidationReport& found);

/// Returns the message of --strict, without the input's name: the first warning or error, and the
/// number of other rules that found one. Without either, the message says where the search for
/// crossings ended; `max_pairs` is its limit.
[[nodiscard]] std::string strict_refusal(const report::ValidationReport& found,
                                         std::uint64_t max_pairs);

/// Returns the summary of the findings, and of the repair before them if any, that the baked file
/// stores. The text is JSON without file names.
[[nodiscard]] std::string kept_findings(const report::ValidationReport& found,
                                        const std::optional<mesh::RepairReport>& repair);

}  // namespace cdprep::cli
