// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace cdprep::cli {

/// Adds -q to a command: no report on standard output and no progress; what fails still stands on
/// standard error, and the exit code tells.
void add_quiet(CLI::App& command);

/// Whether -q was given.
[[nodiscard]] bool is_quiet();

}  // namespace cdprep::cli
