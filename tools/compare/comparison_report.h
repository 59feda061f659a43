// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace cdprep::report {

/// The result of a comparison, or why it failed.
struct ComparisonReport {
    std::string input;  ///< the model that failed, if one did
    int exit = 0;
    std::string error;  ///< empty: none
    study::Comparison comparison;
};

/// Returns aligned tables for people, at most 118 columns wide. Wider tables continue below.
[[nodiscard]] std::string comparison_text(const study::Comparison& comparison);

/// Returns JSON that follows comparison.schema.json: every cell has a "value" or a "text", or else
/// a "reason". Numbers are in seconds, MiB or shares.
[[nodiscard]] std::string comparison_json(const ComparisonReport& report);

/// Returns one line per cell: table,row,column,unit,value,text,reason,published,mark,remark, then
/// the details of timings. Lines that begin with # state the settings; at the end they list the
/// checks.
[[nodiscard]] std::string comparison_csv(const study::Comparison& comparison);

/// Returns a cell's value with its unit, for people. A cell without a value gives its reason in
/// brackets.
[[nodiscard]] std::string cell_text(const study::Cell& cell, study::Unit unit);
/// Returns the published content of a cell with a sign. The sign is * for other counts, ~ for a
/// substitute mesh, ! for an erratum, # for a figure that cannot be compared. Returns "" if nothing
/// was published.
[[nodiscard]] std::string published_text(const study::Cell& cell, study::Unit unit);

/// Returns all settings of the measurements, a sentence each.
[[nodiscard]] std::vector<std::string> provenance_lines(const study::Comparison& comparison);

/// Returns the name of a verdict in JSON and CSV.
[[nodiscard]] const char* verdict_name(study::Verdict verdict) noexcept;
/// Returns the verdict for readers.
[[nodiscard]] const char* verdict_text(study::Verdict verdict) noexcept;
[[nodiscard]] const char* unit_name(study::Unit unit) noexcept;
[[nodiscard]] const char* mark_name(study::Mark mark) noexcept;

}  // namespace cdprep::report
