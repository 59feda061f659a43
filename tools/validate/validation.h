// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "import/import_file.h"
#include "cli/input_list.h"
#include "validate/defects/find_defects.h"
#include "cli/program_threads.h"
#include "validate/baseline.h"
#include "validate/validation_run.h"

namespace cdprep::cli {

struct ValidationOptions {
    mesh::DefectOptions defects;  ///< without max_places and parallel_for, which follow
    import::ImportOptions import;
    report::ValidationRun run;
    std::size_t kept_places = 0;                 ///< of each finding, for what is written later
    const report::Baseline* baseline = nullptr;  ///< null: all is new
};

struct Validation {
    report::ValidationReport report;
    mesh::TriangleSoup soup;  ///< what was validated; empty for a file that could not be read
};

/// Validates one file: import, find defects, judge them. Calls back with the name of each
/// stage as it begins. Never fails: what went wrong stands in the report, with the exit
/// code for this file.
[[nodiscard]] Validation validate(const Input& input, const ValidationOptions& options,
                                  const Threads& threads,
                                  const std::function<void(const char*)>& begins);

}  // namespace cdprep::cli
