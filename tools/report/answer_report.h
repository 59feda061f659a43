// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "cdprep/collide.h"

namespace cdprep::report {

enum class AnswerFormat : std::uint8_t { text, json, ndjson };

/// The answer for one pose.
struct PairAnswer {
    std::size_t pose = 0;
    bool hit = false;
    std::optional<std::size_t> count;                    ///< overlap only
    std::optional<std::span<const TrianglePair>> pairs;  ///< overlap without --count
    std::optional<Containment> containment;              ///< solid only
};

/// What stands before the first answer, between two and after the last.
[[nodiscard]] const char* answers_begin(AnswerFormat format);
[[nodiscard]] const char* answers_between(AnswerFormat format);
[[nodiscard]] const char* answers_end(AnswerFormat format);

/// One answer: a line of NDJSON, an element of a JSON array, or a line of text.
[[nodiscard]] std::string answer(const PairAnswer& answer, AnswerFormat format);

}  // namespace cdprep::report
