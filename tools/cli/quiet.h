// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/command_line.h"

namespace cdprep::cli {

/// Adds -q to a command: no report on standard output and no progress; what fails still stands on
/// standard error, and the exit code tells.
void add_quiet(const Command& command);

/// Whether -q was given.
[[nodiscard]] bool is_quiet();

}  // namespace cdprep::cli
