// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "validate/validation_report.h"

namespace cdprep::report {

/// Returns the path of the node that a source triangle belongs to; "" if the file has none.
[[nodiscard]] std::string node_of(const ValidationReport& report, std::uint32_t triangle);

/// Returns a place as part of a sentence, with at most `most_numbers` numbers of a kind. An
/// example is "triangles 310, 1877 of root/arm at (1, 2, 3); length, model units: 0.5".
[[nodiscard]] std::string place_text(const ValidationReport& report, mesh::Rule rule,
                                     const mesh::Place& place, std::size_t most_numbers);

/// Returns "12", or "at least 12" if a limit ended the search.
[[nodiscard]] std::string count_text(const mesh::Finding& finding, std::uint64_t count);

}  // namespace cdprep::report
