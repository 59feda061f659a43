// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace cdprep::report {

/// A text for a line of a terminal: control characters, which names of files may have,
/// as "\\n", "\\t" or "\\x1b". Nothing else changes, so it cannot be undone.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace cdprep::report
