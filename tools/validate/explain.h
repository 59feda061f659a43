// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "validate/defects/rule.h"

namespace cdprep::report {

/// What a rule means, why it matters, what mends it, how it is decided: for people.
[[nodiscard]] std::string explain_text(const mesh::RuleText& rule);

/// A line a rule: id, severity, name, title.
[[nodiscard]] std::string rule_list_text(std::span<const mesh::RuleText> rules);

/// {"rules": [...]}: all of it.
[[nodiscard]] std::string explain_json(std::span<const mesh::RuleText> rules);

}  // namespace cdprep::report
