// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "cdprep/result.h"

namespace cdprep::cli {

/// Turns SIGINT and SIGTERM into a flag, so that work stops between two stages
/// and leaves no temporary behind. A second signal ends the process at once. A
/// write beyond the permitted file size fails instead of ending the process.
void watch_for_interrupts();

[[nodiscard]] bool is_interrupted();

/// Whether who read our output has ended, as `head` does: then there is nobody to complain to.
[[nodiscard]] bool is_output_closed();

/// Why nothing came of an input after that.
[[nodiscard]] Error interrupted(const std::filesystem::path& input);

}  // namespace cdprep::cli
