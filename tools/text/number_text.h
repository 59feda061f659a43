// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace cdprep::report {

/// Returns the shortest text that reads back as the same number.
[[nodiscard]] std::string number_text(double number);

/// Returns the number with `digits` digits after the point.
[[nodiscard]] std::string fixed(double value, int digits);

/// Returns the number with at most six digits.
[[nodiscard]] std::string in_six_digits(double value);

/// Returns an upper bound as in_six_digits(), rounded upwards: the text never reads back as less.
[[nodiscard]] std::string at_most_in_six_digits(double bound);

/// Returns a lower bound as in_six_digits(), rounded downwards: the text never reads back as more.
[[nodiscard]] std::string at_least_in_six_digits(double bound);

/// Returns the number as std::printf() writes it by a pattern such as "%.3g".
[[nodiscard]] std::string printed(double value, const char* pattern);

/// Returns a size in metres, such as "0.034 x 0.016 x 0.016 m". A unit of 0 counts as a metre.
[[nodiscard]] std::string size_text(const std::array<double, 3>& size, double metres_per_unit);

/// Returns a count with its noun: "1 triangle", "2 triangles".
[[nodiscard]] std::string counted(std::uint64_t count, const char* one, const char* many);

/// Returns 16 hexadecimal digits.
[[nodiscard]] std::string hexadecimal(std::uint64_t value);

}  // namespace cdprep::report
