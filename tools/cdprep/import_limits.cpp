// SPDX-License-Identifier: GPL-3.0-or-later
#include "import_limits.h"

#include <chrono>

namespace cdprep::cli {
namespace {

constexpr int kMostSeconds = 1'000'000;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 50;

}  // namespace

// Spelled out: clang-format takes a line that starts with "import" for a module's.
cdprep::import::ImportOptions ImportLimits::options() const {
    import::ImportOptions options;
    options.memory_bytes = memory_bytes;
    options.file_bytes = file_bytes;
    options.time = std::chrono::seconds(seconds);
    return options;
}

void add_import_limits(CLI::App& command, ImportLimits& limits) {
    command
        .add_option("--import-memory", limits.memory_bytes,
                    "Most memory an import may use, such as 2GB")
        ->transform(CLI::AsSizeValue(false))
        ->check(CLI::Range(std::uint64_t{1}, kMostBytes));
    command
        .add_option("--import-file-size", limits.file_bytes, "Largest file to import, such as 4GB")
        ->transform(CLI::AsSizeValue(false))
        ->check(CLI::Range(std::uint64_t{1}, kMostBytes));
    command.add_option("--import-time", limits.seconds, "Most seconds an import may take")
        ->check(CLI::Range(1, kMostSeconds));
}

}  // namespace cdprep::cli
