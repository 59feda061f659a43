// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "validate/defects/find_defects.h"
#include "text/stage_time.h"

namespace cdprep::report {

/// What a run's settings and baseline make of one finding.
struct Judgement {
    mesh::Severity severity = mesh::Severity::warning;
    std::uint64_t fresh = 0;                  ///< those that the baseline lacks; without one: all
    std::vector<std::uint64_t> fingerprints;  ///< one a place
};

/// What validating one file gave. With a baseline, `defects.findings` has only what is
/// new; `defects.counts` and `defects.verdicts` always tell of the whole mesh.
struct ValidationReport {
    std::string input;
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    mesh::DefectReport defects;
    std::vector<Judgement> judgements;  ///< one a finding
    std::uint64_t known = 0;            ///< findings that the baseline has too
    std::vector<std::string> remarks;   ///< sentences on limits, and on how they were compared
    std::vector<std::string> node_of_triangle_run;  ///< node paths, one an instance
    std::vector<std::uint32_t> first_triangle;      ///< of each instance, ascending
    double seconds = 0;
    std::vector<StageTime> stages;
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the sentence, when it could not be read
    bool known_error = false;          ///< the baseline says so too
};

/// A report that knows a mesh and its nodes, and nothing yet of what is wrong with it.
[[nodiscard]] ValidationReport report_on(const std::string& input, const mesh::TriangleSoup& soup);

/// Adds the sentence that says where a limit ended the search for pairs, if one did.
void remark_on_limits(ValidationReport& report, const mesh::DefectOptions& options);

}  // namespace cdprep::report
