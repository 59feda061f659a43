// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>

#include "cdprep/result.h"

namespace cdprep::scenes {

/// The content of a JSON file, and the line of each value.
// NOLINTNEXTLINE(bugprone-exception-escape): moving what was parsed does not throw
struct JsonFile {
    std::string name;  ///< for messages
    nlohmann::json root;
    std::unordered_map<std::string, std::size_t> lines;  ///< by JSON pointer (RFC 6901)
};

/// Returns the JSON pointer to a member below another pointer.
[[nodiscard]] std::string pointer_below(const std::string& pointer, std::string_view key);

/// Parses JSON. Fails with `unreadable` if the text is no JSON in UTF-8 or an object has a key
/// twice. Also fails if values are nested deeper than 128 levels. The message names the line.
[[nodiscard]] Result<JsonFile> parse_json_file(const std::string& name, const std::string& text);

}  // namespace cdprep::scenes
