// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "text/stage_time.h"
#include "validate/defects/find_defects.h"

namespace cdprep::report {

/// The judgement of one finding by a run's settings and baseline.
struct Judgement {
    mesh::Severity severity = mesh::Severity::warning;
    std::uint64_t fresh = 0;                  ///< not in the baseline; without a baseline: all
    std::vector<std::uint64_t> fingerprints;  ///< one per place
};

/// The result of validating one file. With a baseline, `defects.findings` holds only the new
/// findings. `defects.counts` and `defects.verdicts` always describe the whole mesh.
struct ValidationReport {
    std::string input;
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    mesh::DefectReport defects;
    std::vector<Judgement> judgements;  ///< one per finding
    std::uint64_t known = 0;            ///< findings that the baseline also contains
    std::vector<std::string> remarks;   ///< on imports, colliders left out, limits, comparisons
    std::vector<std::string> node_of_triangle_run;  ///< node paths, one per instance
    std::vector<std::uint32_t> first_triangle;      ///< of each instance, ascending
    double seconds = 0;
    std::vector<StageTime> stages;
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the message, if the file could not be read
    bool known_error = false;          ///< the baseline has this error too
};

/// Returns a report with the mesh and its nodes, without findings.
[[nodiscard]] ValidationReport report_on(const std::string& input, const mesh::TriangleSoup& soup);

/// Adds a remark for each search that a limit ended.
void remark_on_limits(ValidationReport& report, const mesh::DefectOptions& options);

}  // namespace cdprep::report
