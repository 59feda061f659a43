// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "study/table.h"
#include "study/timing.h"

/// Functions that make table cells and their text.
namespace cdprep::study {

[[nodiscard]] Cell number(double value);
[[nodiscard]] Cell word(std::string text);
/// Returns an empty cell with the reason.
[[nodiscard]] Cell without(std::string reason);
[[nodiscard]] Cell count_cell(std::uint64_t count);
/// Returns a cell with a number of bytes in MiB.
[[nodiscard]] Cell size_cell(double bytes);
/// Returns a cell with the median time and the details of its measurement.
[[nodiscard]] Cell seconds_cell(const Timing& timing);
/// Returns a cell with a time that was measured once.
[[nodiscard]] Cell seconds_cell(double seconds);

/// Returns the number by a printf format with one conversion for a double.
[[nodiscard]] std::string formatted(const char* form, double value);
/// Returns a hash in 16 hexadecimal digits.
[[nodiscard]] std::string hash_text(std::uint64_t hash);
/// Returns seconds in a readable unit: "480 ns", "1.25 ms".
[[nodiscard]] std::string seconds_text(double seconds);

[[nodiscard]] constexpr Verdict verdict_of(bool holds) noexcept {
    return holds ? Verdict::holds : Verdict::fails;
}

}  // namespace cdprep::study
