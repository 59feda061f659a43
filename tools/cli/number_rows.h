// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/result.h"

namespace cdprep::cli {

/// Reads exactly row.size() finite numbers, separated by blanks or commas. Fails with
/// `unreadable` on other text; the message begins with `place` and states what was found.
[[nodiscard]] Result<Done> parse_row(std::string_view text, const std::string& place,
                                     std::span<double> row);

/// Calls `take` with each line of a text file, or of standard input for "-", and its place,
/// "FILE: line 3". Skips empty lines and lines that start with #. `note` gets the text after that
/// #, without surrounding blanks. Stops at the first failure of `take`. Fails with `unreadable`
/// if the file cannot be read.
[[nodiscard]] Result<Done> for_each_line(
    const std::filesystem::path& path,
    const std::function<Result<Done>(const std::string& line, const std::string& place)>& take,
    const std::function<void(std::string_view note)>& note = {});

}  // namespace cdprep::cli
