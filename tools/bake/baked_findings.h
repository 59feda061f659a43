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

/// Says what is wrong with a mesh as it is baked: `soup` with the vertices that `welded`
/// joined in one place. Its exit code is that of findings where one is a warning or more:
/// what --strict refuses.
[[nodiscard]] report::ValidationReport find_for_bake(const std::string& input,
                                                     const mesh::TriangleSoup& soup,
                                                     const mesh::Mesh& welded,
                                                     std::uint64_t max_pairs,
                                                     ParallelFor parallel_for);

/// How many rules found a warning or more.
[[nodiscard]] std::uint64_t count_warnings(const report::ValidationReport& found);

/// The sentence with which --strict refuses: the first finding that is a warning or more,
/// and how many there are.
[[nodiscard]] std::string strict_refusal(const report::ValidationReport& found);

/// What the file keeps of it and of the repair before, if any: JSON, without names of
/// files.
[[nodiscard]] std::string kept_findings(const report::ValidationReport& found,
                                        const std::optional<mesh::RepairReport>& repair);

}  // namespace cdprep::cli
