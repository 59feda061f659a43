// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

#include "import/import_file.h"

namespace cdprep::cli {

/// --import-memory, --import-file-size and --import-time.
struct ImportLimits {
    std::uint64_t memory_bytes = import::ImportOptions{}.memory_bytes;
    std::uint64_t file_bytes = import::ImportOptions{}.file_bytes;
    std::uint64_t seconds = static_cast<std::uint64_t>(import::ImportOptions{}.time.count());

    [[nodiscard]] import::ImportOptions options() const;
};

/// Adds the options to a command; `limits` lives as long as it.
void add_import_limits(CLI::App& command, ImportLimits& limits);

}  // namespace cdprep::cli
