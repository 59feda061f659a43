// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "validate/validation_run.h"

namespace cdprep::report {

/// What was found in one file, for people.
[[nodiscard]] std::string validation_text(const ValidationReport& report, const ValidationRun& run);

/// At most this many places of one finding, a line each, and how many more there are.
[[nodiscard]] std::string places_text(const ValidationReport& report, std::size_t finding,
                                      std::size_t most, const std::string& indent);

/// One line on all files.
[[nodiscard]] std::string totals_text(const ValidationTotals& totals);

}  // namespace cdprep::report
