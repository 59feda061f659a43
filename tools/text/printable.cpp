// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/printable.h"

#include <algorithm>

namespace cdprep::report {
namespace {

/// Returns the number of bytes of the control character at the front of the text; 0 if there is
/// none.
std::size_t control_length(std::string_view text) {
    const char first = text[0];
    if ((first >= 0 && first < ' ') || first == '\x7f') return 1;
    // U+0080 to U+009F, which terminals may interpret too.
    const bool is_long = first == '\xc2' && text.size() > 1 &&
                         text.substr(1, 1) >= std::string_view("\x80") &&
                         text.substr(1, 1) < std::string_view("\xa0");
    return is_long ? 2 : 0;
}

std::string escaped(char c) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    constexpr unsigned kDigitBits = 4;
    constexpr unsigned kDigitMask = 15;
    if (c == '\n') return "\\n";
    if (c == '\r') return "\\r";
    if (c == '\t') return "\\t";
    const auto byte = static_cast<unsigned char>(c);
    return std::string("\\x") + kDigits[byte >> kDigitBits] + kDigits[byte & kDigitMask];
}

}  // namespace

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const std::size_t control = control_length(text);
        for (const char c : text.substr(0, control)) result += escaped(c);
        if (control == 0) result += text[0];
        text.remove_prefix(std::max<std::size_t>(control, 1));
    }
    return result;
}

}  // namespace cdprep::report
