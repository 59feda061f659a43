// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "query/answer_report.h"

namespace cdprep::report {

/// Which triangles of one model are inaccessible.
struct InaccessibleAnswer {
    std::uint64_t count = 0;
    std::uint64_t edge_on = 0;                              ///< of which the criterion says nothing
    std::uint64_t triangles = 0;                            ///< of the model
    std::optional<std::span<const std::uint32_t>> numbers;  ///< source numbers, rising
};

/// Text: a sentence, then the numbers, one a line. JSON and NDJSON: one object,
/// {"count": 2, "edge_on": 0, "triangles": 12, "inaccessible": [3, 7]}.
[[nodiscard]] std::string inaccessible_text(const InaccessibleAnswer& answer, AnswerFormat format);

}  // namespace cdprep::report
