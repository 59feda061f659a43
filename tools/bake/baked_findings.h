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

/// Finds the defects of a mesh as it is baked: `soup` with the vertices that `welded` joined in one
/// place. The exit code is Exit::findings if a finding is a warning or an error, which --strict
/// refuses. The report names no input.
[[nodiscard]] report::ValidationReport find_for_bake(const mesh::TriangleSoup& soup,
                                                     const mesh::Mesh& welded,
                                                     std::uint64_t max_pairs,
                                                     ParallelFor parallel_for);

/// How many rules found a warning or more.
[[nodiscard]] std::uint64_t count_warnings(const report::ValidationReport& found);

/// The message of --strict, without the input's name: the first warning or error, and how many
/// rules found one.
[[nodiscard]] std::string strict_refusal(const report::ValidationReport& found);

/// What the file keeps of it and of the repair before, if any: JSON, without names of
/// files.
[[nodiscard]] std::string kept_findings(const report::ValidationReport& found,
                                        const std::optional<mesh::RepairReport>& repair);

}  // namespace cdprep::cli
