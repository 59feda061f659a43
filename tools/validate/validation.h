// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "cli/input_list.h"
#include "cli/program_threads.h"
#include "import/import_file.h"
#include "validate/baseline.h"
#include "validate/defects/find_defects.h"
#include "validate/validation_run.h"

namespace cdprep::cli {

struct ValidationOptions {
    mesh::DefectOptions defects;  ///< max_places, stop and parallel_for are set by validate()
    import::ImportOptions import;
    bool leaves_out_colliders = false;  ///< as leave_out_colliders() does
    report::ValidationRun run;
    std::size_t kept_places = 0;                 ///< per finding, for reports written later
    const report::Baseline* baseline = nullptr;  ///< null: all findings are new
};

struct Validation {
    report::ValidationReport report;
    mesh::TriangleSoup soup;    ///< the validated soup; empty for a file that could not be read
    bool has_conflict = false;  ///< the import found one: the report must not become a file
};

/// Validates one file: imports it, finds defects, judges them. Calls `begins` with the name of
/// each stage. Never fails: the report contains the error, and the exit code for this file.
[[nodiscard]] Validation validate(const Input& input, const ValidationOptions& options,
                                  const Threads& threads,
                                  const std::function<void(const char*)>& begins);

}  // namespace cdprep::cli
