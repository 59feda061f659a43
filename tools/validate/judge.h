// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "mesh/mesh.h"
#include "validate/baseline.h"
#include "validate/rule_settings.h"
#include "validate/validation_report.h"

namespace cdprep::report {

struct JudgeOptions {
    const RuleSettings& rules;
    const KnownMesh* known;  ///< null: no baseline, all findings are new
    std::size_t max_places;  ///< kept per finding; writers may list fewer
};

/// Gives each finding its severity and fingerprints. Removes findings whose rule is off and,
/// with a baseline, those that the baseline contains. Returns whether the remaining findings
/// make the run fail.
///
/// Compares places if baseline and report both have every place of the rule; otherwise compares
/// counts and adds a remark. The report should keep all places of the baseline plus max_places.
/// It then contains enough new places.
[[nodiscard]] bool judge(ValidationReport& report, const mesh::TriangleSoup& soup,
                         const JudgeOptions& options);

/// Returns whether crossing, touching or overlapping triangles make the run fail. The run then
/// also fails if a limit ended the search for them.
[[nodiscard]] bool fails_on_pairs(const RuleSettings& rules);

}  // namespace cdprep::report
