// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace cdprep::report {

/// A cell of CSV that holds this text: in quotes, quotes in it doubled (RFC 4180), on one line.
[[nodiscard]] inline std::string csv_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '"') quoted += '"';
        quoted += letter == '\n' || letter == '\r' ? ' ' : letter;
    }
    return quoted + '"';
}

}  // namespace cdprep::report
