// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace cdprep::report {

/// Returns a CSV cell that holds the text: in quotes, with inner quotes doubled (RFC 4180). Line
/// ends become blanks, so the cell stays on one line.
[[nodiscard]] inline std::string csv_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '"') quoted += '"';
        quoted += letter == '\n' || letter == '\r' ? ' ' : letter;
    }
    return quoted + '"';
}

}  // namespace cdprep::report
