// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "command_line/command_page.h"

namespace cdprep::cli {

/// Returns the text of --help: usage, options by group, notes, examples, in 80 columns.
[[nodiscard]] std::string help_text(const CommandPage& page);

/// Makes help_text() the help of a program and all its commands.
void use_help_text(CLI::App& program);

}  // namespace cdprep::cli
