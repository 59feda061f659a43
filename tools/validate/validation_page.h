// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <filesystem>
#include <vector>

#include "cli/report_output.h"
#include "validate/validation.h"

namespace cdprep::cli {

/// The page of --html: holds every mesh of the run until it is written.
class ValidationPage {
public:
    /// Begins the file, so that a place where none can be is said before the work. Fails
    /// with `unwritable`.
    [[nodiscard]] static Result<ValidationPage> open(const std::filesystem::path& path);

    void add(Validation validation);

    /// Call once, after the last mesh. Without it no file appears.
    [[nodiscard]] Result<Done> finish();

private:
    explicit ValidationPage(ReportOutput output) : output_(std::move(output)) {}

    ReportOutput output_;
    std::deque<Validation> meshes_;
};

}  // namespace cdprep::cli
