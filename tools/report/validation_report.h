// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/find_defects.h"
#include "report/bake_report.h"

namespace cdprep::report {

/// What validating one file gave.
struct ValidationReport {
    std::string input;
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    mesh::DefectReport defects;
    std::vector<std::string> node_of_triangle_run;  ///< node paths, one an instance
    std::vector<std::uint32_t> first_triangle;      ///< of each instance, ascending
    double seconds = 0;
    std::vector<StageTime> stages;
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the sentence, when it could not be read
};

}  // namespace cdprep::report
