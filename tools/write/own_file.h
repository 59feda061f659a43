// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "cdprep/result.h"

namespace cdprep::write {

/// The first line of files beside an output, by which a later run knows that it may replace them.
inline constexpr std::string_view kOwnLine = "# written by cdprep\n";

/// Returns an error if there is such a file without that line. No argument names the file, so one
/// that somebody else wrote must stay.
[[nodiscard]] std::optional<Error> find_foreign(const std::filesystem::path& file);

}  // namespace cdprep::write
