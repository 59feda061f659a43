// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace cdprep::report {

/// Returns a text that is safe on a line of a terminal. Control characters, which file names may
/// contain, become "\\n", "\\t" or "\\x1b". Nothing else changes: backslashes are not escaped, so
/// the result cannot be converted back.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace cdprep::report
