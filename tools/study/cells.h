// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "study/table.h"
#include "study/timing.h"

/// How cells come about.
namespace cdprep::study {

[[nodiscard]] Cell number(double value);
[[nodiscard]] Cell word(std::string text);
/// An empty cell, and why it is.
[[nodiscard]] Cell without(std::string reason);
[[nodiscard]] Cell count_cell(std::uint64_t count);
/// Of bytes, in MiB.
[[nodiscard]] Cell size_cell(double bytes);
/// The median, with what it was found from.
[[nodiscard]] Cell seconds_cell(const Timing& timing);
/// Seconds that were measured once.
[[nodiscard]] Cell seconds_cell(double seconds);

/// The number by a printf form that has one place for a double.
[[nodiscard]] std::string formatted(const char* form, double value);
/// A hash in 16 digits.
[[nodiscard]] std::string hash_text(std::uint64_t hash);
/// Seconds as people read them: "480 ns", "1.25 ms".
[[nodiscard]] std::string seconds_text(double seconds);

[[nodiscard]] constexpr Verdict verdict_of(bool holds) noexcept {
    return holds ? Verdict::holds : Verdict::fails;
}

}  // namespace cdprep::study
