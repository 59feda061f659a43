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
    const KnownMesh* known;  ///< null: nothing is known, all is new
    std::size_t max_places;  ///< kept of each finding; writers may list fewer
};

/// Gives each finding its severity and fingerprints, leaves out those whose rule is off
/// and, with a baseline, what it has too. Returns whether what is left makes the run
/// fail.
///
/// Places are compared where the baseline has every place of a rule and the report
/// too; else numbers are, which a remark says. The report should keep as many places as
/// the baseline has and max_places more, so that enough new ones are among them.
[[nodiscard]] bool judge(ValidationReport& report, const mesh::TriangleSoup& soup,
                         const JudgeOptions& options);

/// Whether the run fails when triangles cross, touch or overlap. Then it also fails when a
/// limit ended the search for them.
[[nodiscard]] bool fails_on_pairs(const RuleSettings& rules);

}  // namespace cdprep::report
