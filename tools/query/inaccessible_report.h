// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "query/answer_report.h"

namespace cdprep::report {

/// The inaccessible triangles of one model.
struct InaccessibleAnswer {
    std::uint64_t count = 0;
    std::uint64_t edge_on = 0;                              ///< the criterion does not apply
    std::uint64_t triangles = 0;                            ///< of the model
    std::optional<std::span<const std::uint32_t>> numbers;  ///< source numbers, ascending
};

/// Returns the answer in a format. Text is a sentence, then the numbers, one per line. JSON and
/// NDJSON are one object, {"count": 2, "edge_on": 0, "triangles": 12, "inaccessible": [3, 7]}.
[[nodiscard]] std::string inaccessible_text(const InaccessibleAnswer& answer, AnswerFormat format);

}  // namespace cdprep::report
