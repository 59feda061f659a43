// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace cdprep::report {

/// Returns a text escaped as the content or an attribute of an element.
[[nodiscard]] std::string escaped(std::string_view text);

/// Returns JSON for a script element. No text in it can end the element. Bytes that are not
/// UTF-8 become U+FFFD.
template <class Json>
[[nodiscard]] std::string script_json(const Json& value) {
    const std::string plain = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(plain.size());
    for (const char letter : plain) {
        if (letter == '<') {
            safe += "\\u003c";
        } else if (letter == '>') {
            safe += "\\u003e";
        } else if (letter == '&') {
            safe += "\\u0026";
        } else {
            safe += letter;
        }
    }
    return safe;
}

/// Returns a script element that holds data.
[[nodiscard]] std::string script_element(const std::string& id, const char* type,
                                         const std::string& content);

/// Returns the frame with each name of `parts` replaced by its text. Names begin with '@'.
/// Inserted text is not searched again.
[[nodiscard]] std::string filled(std::string_view frame,
                                 std::span<const std::pair<std::string_view, std::string>> parts);

}  // namespace cdprep::report
