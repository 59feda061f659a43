// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "command_line/command_line.h"

namespace cdprep::cli {

/// Whether the environment lets terminals be coloured: NO_COLOR is unset or empty.
[[nodiscard]] bool colours_allowed();

/// Adds --color.
void add_colour(const Command& command, std::string& choice);

/// What --color comes to for standard output: "auto" colours terminals where colours_allowed().
[[nodiscard]] bool is_coloured(const std::string& choice);

}  // namespace cdprep::cli
