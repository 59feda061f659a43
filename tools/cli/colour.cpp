// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/colour.h"

#include <unistd.h>

#include <cstdlib>

#include "command_line/command_line.h"

namespace cdprep::cli {

bool colours_allowed() {
    const char* no_color = std::getenv("NO_COLOR");  // NOLINT(concurrency-mt-unsafe)
    return no_color == nullptr || *no_color == '\0';
}

void add_colour(const Command& command, std::string& choice) {
    command
        .add_option("--color,--colour", choice,
                    "Colours of text; auto: on a terminal, unless NO_COLOR is set")
        .type_name("WHEN")
        .check(one_of({"auto", "always", "never"}))
        .show_default()
        .group("General");
}

bool is_coloured(const std::string& choice) {
    if (choice != "auto") return choice == "always";
    return ::isatty(STDOUT_FILENO) != 0 && colours_allowed();
}

}  // namespace cdprep::cli
