// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "validate/validation_run.h"

namespace cdprep::report {

/// The values of `report` and `version` in a JSON report; validation.schema.json defines the
/// rest. The version rises when an older reader would misread a newer report.
inline constexpr const char* kValidationReportName = "cdprep-validate";
inline constexpr int kValidationReportVersion = 1;

/// The parts of a JSON report: the head, the meshes with commas between them, the tail.
[[nodiscard]] std::string validation_json_head(const ValidationRun& run);
[[nodiscard]] std::string validation_json_mesh(const ValidationReport& report,
                                               const ValidationRun& run);
[[nodiscard]] std::string validation_json_tail(const ValidationTotals& totals);

/// Returns the findings that a baked file keeps: the mesh object without file names. Adds
/// `repair`, the result of repair_summary_json(), as "repair" unless it is empty.
[[nodiscard]] std::string baked_findings_json(const ValidationReport& report,
                                              const std::string& repair, std::size_t max_places);

/// Returns the mesh object on a line of its own.
[[nodiscard]] std::string validation_ndjson(const ValidationReport& report,
                                            const ValidationRun& run);

/// Returns the flat object `counts`: every member of DefectCounts by its name.
[[nodiscard]] nlohmann::ordered_json counts_json(const mesh::DefectCounts& counts);

}  // namespace cdprep::report
