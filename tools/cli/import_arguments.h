// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "import/import_file.h"

#include "command_line/command_line.h"

namespace cdprep::cli {

/// The options of every command that imports: --import-memory, --import-file-size,
/// --import-time, --unit, --up-axis and --allow-empty.
struct ImportArguments {
    std::uint64_t memory_bytes = import::ImportOptions{}.memory_bytes;
    std::uint64_t file_bytes = import::ImportOptions{}.file_bytes;
    std::uint64_t seconds = static_cast<std::uint64_t>(import::ImportOptions{}.time.count());
    std::string unit;     ///< "mm", "cm", "m", "in" or "ft"; empty: the unit of the file
    std::string up_axis;  ///< "y" or "z"; empty: the axis of the file
    bool allow_empty = false;

    /// Returns the options of an import that fails with bad_argument if the input refers to one of
    /// the outputs: that file would be replaced. An empty path is none.
    [[nodiscard]] import::ImportOptions options(
        const std::vector<std::filesystem::path>& outputs = {}) const;
};

/// Adds the options to a command. `arguments` must outlive the command.
void add_import_arguments(const Command& command, ImportArguments& arguments);

}  // namespace cdprep::cli
