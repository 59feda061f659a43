// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace cdprep::report {

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string number_text(double number);

/// The number with so many digits after the point.
[[nodiscard]] std::string fixed(double value, int digits);

/// The number with at most six digits.
[[nodiscard]] std::string in_six_digits(double value);

/// "1 triangle", "2 triangles".
[[nodiscard]] std::string counted(std::uint64_t count, const char* one, const char* many);

}  // namespace cdprep::report
