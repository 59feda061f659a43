// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "command_line/command_line.h"

namespace cdprep::cli {

/// Returns true if NO_COLOR is unset or empty: the environment then permits colours on terminals.
[[nodiscard]] bool colours_allowed();

/// Adds --color.
void add_colour(const Command& command, std::string& choice);

/// Returns true if standard output is coloured under this value of --color. "auto" means: on a
/// terminal, if colours_allowed().
[[nodiscard]] bool is_coloured(const std::string& choice);

}  // namespace cdprep::cli
