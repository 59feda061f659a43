// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cdprep/model.h"

namespace cdprep::report {

/// Returns a JSON array with one object per hull of an open model.
[[nodiscard]] nlohmann::ordered_json baked_hulls_json(const Model& model);

/// Returns one indented line per hull for people, at most `most_lines`. Empty without hulls.
[[nodiscard]] std::string baked_hulls_text(const Model& model, std::size_t most_lines);

}  // namespace cdprep::report
