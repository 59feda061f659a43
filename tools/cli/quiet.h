// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/command_line.h"

namespace cdprep::cli {

/// Adds -q to a command: no report on standard output and no progress. Failures still appear on
/// standard error and in the exit code.
void add_quiet(const Command& command);

/// Returns true if -q was given.
[[nodiscard]] bool is_quiet();

}  // namespace cdprep::cli
