// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <string>

namespace cdprep::report {

/// The number with so many digits behind the point.
[[nodiscard]] inline std::string fixed(double value, int digits) {
    // The largest double has 309 digits before the point.
    std::string text(384, '\0');
    const int size = std::snprintf(text.data(), text.size(), "%.*f", digits, value);
    text.resize(static_cast<std::size_t>(size));
    return text;
}

/// The number with at most six digits.
[[nodiscard]] inline std::string in_six_digits(double value) {
    std::string text(32, '\0');
    const int size = std::snprintf(text.data(), text.size(), "%.6g", value);
    text.resize(static_cast<std::size_t>(size));
    return text;
}

}  // namespace cdprep::report
