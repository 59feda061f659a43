// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "validate/defects/rule.h"

namespace cdprep::report {

/// Returns a text for people: definition, effect, repair and method of decision of a rule.
[[nodiscard]] std::string explain_text(const mesh::RuleText& rule);

/// Returns one line per rule: id, severity, name, title.
[[nodiscard]] std::string rule_list_text(std::span<const mesh::RuleText> rules);

/// Returns all texts as JSON: {"rules": [...]}.
[[nodiscard]] std::string explain_json(std::span<const mesh::RuleText> rules);

}  // namespace cdprep::report
