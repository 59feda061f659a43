// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <filesystem>

#include "cli/report_output.h"
#include "validate/validation.h"

namespace cdprep::cli {

/// The page of --html. It holds every mesh of the run until it is written.
class ValidationPage {
public:
    /// Creates the file, so that an unwritable place is reported before the work. Fails with
    /// `unwritable`.
    [[nodiscard]] static Result<ValidationPage> open(const std::filesystem::path& path);

    void add(Validation validation);

    /// Writes the page. Call it once, after the last mesh; otherwise no file appears.
    [[nodiscard]] Result<Done> finish();

private:
    explicit ValidationPage(ReportOutput output) : output_(std::move(output)) {}

    ReportOutput output_;
    std::deque<Validation> meshes_;
};

}  // namespace cdprep::cli
