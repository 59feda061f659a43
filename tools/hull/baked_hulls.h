// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cdprep/model.h"

namespace cdprep::report {

/// An object for each hull of an open model.
[[nodiscard]] nlohmann::ordered_json baked_hulls_json(const Model& model);

/// A line for each, for a person, indented; at most `most_lines`. Empty without hulls.
[[nodiscard]] std::string baked_hulls_text(const Model& model, std::size_t most_lines);

}  // namespace cdprep::report
