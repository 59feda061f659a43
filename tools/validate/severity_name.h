// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>

#include "validate/defects/rule.h"

namespace cdprep::report {

/// Returns "off", "note", "warning" or "error".
[[nodiscard]] const char* severity_name(mesh::Severity severity) noexcept;

/// Returns the severity of that name, also for "warn"; nothing for another word.
[[nodiscard]] std::optional<mesh::Severity> find_severity(std::string_view word) noexcept;

}  // namespace cdprep::report
