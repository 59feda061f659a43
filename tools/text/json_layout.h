// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cdprep/format/geometry.h"

namespace cdprep::report {

/// Returns the value of a text of unknown origin, discarded if the text is not JSON. So is a value
/// nested so deeply that printing it would overflow the stack.
template <class Json = nlohmann::ordered_json>
[[nodiscard]] Json parsed(std::string_view text) {
    constexpr int kMostLevels = 128;
    bool is_deep = false;
    const auto check = [&](int depth, typename Json::parse_event_t /*event*/, Json& /*value*/) {
        is_deep = is_deep || depth > kMostLevels;
        return !is_deep;
    };
    Json json = Json::parse(text, check, false);
    return is_deep ? Json(Json::value_t::discarded) : json;
}

/// Returns JSON laid out for people and for diff. A value that fits on a line stays on one; others
/// are broken and indented, starting at `depth` steps. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string laid_out(const nlohmann::ordered_json& json, int depth);

/// Returns JSON on one line. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string compact(const nlohmann::ordered_json& json);

/// Returns JSON with one value per line, indented by two blanks a step, and a line end. Bytes that
/// are not UTF-8 are replaced.
[[nodiscard]] std::string indented(const nlohmann::ordered_json& json);

/// Returns the text with the bytes that are not UTF-8 replaced, as laid_out() replaces them.
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// Returns an array of three numbers. A number that is not finite prints as null.
[[nodiscard]] nlohmann::ordered_json position_json(const format::Double3& position);

}  // namespace cdprep::report
