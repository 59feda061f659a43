// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace cdprep::report {

/// How a comparison went, or why nothing came of it.
struct ComparisonReport {
    std::string input;  ///< the model that failed, if one did
    int exit = 0;
    std::string error;  ///< empty: none
    study::Comparison comparison;
};

/// Aligned tables for people, at most 118 columns wide: tables that are wider go on below.
[[nodiscard]] std::string comparison_text(const study::Comparison& comparison);

/// As comparison.schema.json says: every cell has a "value" or a "text", or else a "reason".
/// Numbers are in seconds, MiB, shares.
[[nodiscard]] std::string comparison_json(const ComparisonReport& report);

/// A line a cell: table,row,column,unit,value,text,reason,published,mark,remark, then the
/// details that cells of timings have. Lines that begin with # say how it was measured, and at
/// the end what holds.
[[nodiscard]] std::string comparison_csv(const study::Comparison& comparison);

/// A cell's value with its unit, as people read it; its reason in brackets where it has none.
[[nodiscard]] std::string cell_text(const study::Cell& cell, study::Unit unit);
/// What was published in its place, with * for other counts, ~ for a stand-in, ! for an erratum
/// and # for a figure that cannot be compared; empty when nothing was.
[[nodiscard]] std::string published_text(const study::Cell& cell, study::Unit unit);

/// Everything about how it was measured, a sentence each.
[[nodiscard]] std::vector<std::string> provenance_lines(const study::Comparison& comparison);

[[nodiscard]] const char* verdict_name(study::Verdict verdict) noexcept;
[[nodiscard]] const char* unit_name(study::Unit unit) noexcept;
[[nodiscard]] const char* mark_name(study::Mark mark) noexcept;

}  // namespace cdprep::report
