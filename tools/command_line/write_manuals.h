// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/result.h"
#include "command_line/command_page.h"

namespace cdprep::cli {

/// Returns a man page in troff (man(7)). Its footer contains `version`.
[[nodiscard]] std::string man_page(const CommandPage& page, const std::string& version);

/// Each returns the completion script of one shell for all commands of a program.
[[nodiscard]] std::string bash_completion(const std::vector<CommandPage>& pages);
[[nodiscard]] std::string zsh_completion(const std::vector<CommandPage>& pages);
[[nodiscard]] std::string fish_completion(const std::vector<CommandPage>& pages);

/// Returns docs/COMMANDS.md: exit codes, and a table of options for each command.
[[nodiscard]] std::string command_tables(const std::vector<CommandPage>& pages);

/// Writes man/*.1, completion/{cdprep.bash, _cdprep, cdprep.fish} and COMMANDS.md into a folder.
/// Creates the folder if it is missing. Returns the error, or nothing.
[[nodiscard]] std::optional<Error> write_manuals(const std::filesystem::path& folder,
                                                 const std::vector<CommandPage>& pages,
                                                 const std::string& version);

}  // namespace cdprep::cli
