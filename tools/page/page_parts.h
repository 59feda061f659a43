// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace cdprep::report {

/// Returns a text escaped as the content or an attribute of an element.
[[nodiscard]] std::string escaped(std::string_view text);

/// Returns the text of JSON for a script element: no string in it can end the element.
[[nodiscard]] std::string script_json(std::string_view json);

/// Returns a script element that holds data.
[[nodiscard]] std::string script_element(const std::string& id, const char* type,
                                         const std::string& content);

/// Returns the frame with each name of `parts` replaced by its text. Names begin with '@'.
/// Inserted text is not searched again.
[[nodiscard]] std::string filled(std::string_view frame,
                                 std::span<const std::pair<std::string_view, std::string>> parts);

}  // namespace cdprep::report
