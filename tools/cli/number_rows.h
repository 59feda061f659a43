// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/result.h"

namespace cdprep::cli {

/// Reads exactly row.size() finite numbers with blanks or commas between them.
/// `unreadable` otherwise; the sentence begins with `place` and says what was
/// found.
[[nodiscard]] Result<Done> parse_row(std::string_view text, const std::string& place,
                                     std::span<double> row);

/// Calls `take` with each line of a text file, or of standard input for "-", and its place, "FILE:
/// line 3". Empty lines are skipped, and lines that start with #, of which `note` gets what stands
/// behind that, without blanks around. Stops at the first failure of `take`; `unreadable` when the
/// file cannot be read.
[[nodiscard]] Result<Done> for_each_line(
    const std::filesystem::path& path,
    const std::function<Result<Done>(const std::string& line, const std::string& place)>& take,
    const std::function<void(std::string_view note)>& note = {});

}  // namespace cdprep::cli
