// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "validate/validation_run.h"

namespace cdprep::report {

/// What `report` and `version` say in a JSON report; validation.schema.json has the rest.
/// The version rises when an older reader would misread a newer report.
inline constexpr const char* kValidationReportName = "cdprep-validate";
inline constexpr int kValidationReportVersion = 1;

/// A JSON report is the head, the meshes with commas between them, and the tail.
[[nodiscard]] std::string validation_json_head(const ValidationRun& run);
[[nodiscard]] std::string validation_json_mesh(const ValidationReport& report,
                                               const ValidationRun& run);
[[nodiscard]] std::string validation_json_tail(const ValidationTotals& totals);

/// What a baked file keeps of it: the same mesh without the names of files, and as
/// "repair" what repair_summary_json() said, unless that is empty.
[[nodiscard]] std::string baked_findings_json(const ValidationReport& report,
                                              const std::string& repair, std::size_t max_places);

/// The same mesh on a line of its own.
[[nodiscard]] std::string validation_ndjson(const ValidationReport& report,
                                            const ValidationRun& run);

/// The flat object `counts`: every member of DefectCounts by its name.
[[nodiscard]] nlohmann::ordered_json counts_json(const mesh::DefectCounts& counts);

}  // namespace cdprep::report
