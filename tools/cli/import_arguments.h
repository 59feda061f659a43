// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "import/import_file.h"

#include "command_line/command_line.h"

namespace cdprep::cli {

/// What every command that imports lets a person say about it: --import-memory,
/// --import-file-size, --import-time, --unit, --up-axis and --allow-empty.
struct ImportArguments {
    std::uint64_t memory_bytes = import::ImportOptions{}.memory_bytes;
    std::uint64_t file_bytes = import::ImportOptions{}.file_bytes;
    std::uint64_t seconds = static_cast<std::uint64_t>(import::ImportOptions{}.time.count());
    std::string unit;     ///< of kUnits; empty: what the file says
    std::string up_axis;  ///< "y" or "z"; empty: what the file says
    bool allow_empty = false;

    [[nodiscard]] import::ImportOptions options() const;
};

/// Adds the options to a command; `arguments` lives as long as it.
void add_import_arguments(const Command& command, ImportArguments& arguments);

}  // namespace cdprep::cli
