// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cdprep/format/geometry.h"

namespace cdprep::report {

/// JSON for people and for diff: what fits on a line stands on one, the rest is broken
/// and indented, starting `depth` steps in. Bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string laid_out(const nlohmann::ordered_json& json, int depth);

/// On one line.
[[nodiscard]] std::string compact(const nlohmann::ordered_json& json);

/// The text with bytes that are no UTF-8 replaced, as they are in JSON.
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// Three numbers, null where one is not finite.
[[nodiscard]] nlohmann::ordered_json position_json(const format::Double3& position);

}  // namespace cdprep::report
