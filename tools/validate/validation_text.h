// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "validate/validation_run.h"

namespace cdprep::report {

/// Returns a text for people about the findings in one file.
[[nodiscard]] std::string validation_text(const ValidationReport& report, const ValidationRun& run);

/// Returns at most `most` places of one finding, one per line, and the number of the rest.
[[nodiscard]] std::string places_text(const ValidationReport& report, std::size_t finding,
                                      std::size_t most, const std::string& indent);

/// Returns one line about all files.
[[nodiscard]] std::string totals_text(const ValidationTotals& totals);

}  // namespace cdprep::report
