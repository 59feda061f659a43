// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#ifdef __wasm__
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#else
#include <charconv>
#endif
#include <string>

namespace cdprep {

/// Returns the fewest digits that read back as the same number: 1e-12, not 9.9999999999999998e-13.
/// In WebAssembly, some powers of two have a digit more. The tables of std::to_chars() would be 36
/// kB, by Brotli, of the module that a page loads.
#ifdef __wasm__
inline std::string number_text(double value) {
    std::array<char, 32> digits{};  // holds 17 digits and an exponent
    std::array<char, 32> fixed{};
    if (!std::isfinite(value)) {
        std::snprintf(digits.data(), digits.size(), "%f", value);
        return digits.data();
    }
    int decimals = 0;
    for (; decimals < 17; ++decimals) {
        std::snprintf(digits.data(), digits.size(), "%.*e", decimals, value);
        if (std::strtod(digits.data(), nullptr) == value) break;
    }
    const long exponent = std::strtol(std::strchr(digits.data(), 'e') + 1, nullptr, 10);
    decimals = std::max(0, decimals - static_cast<int>(exponent));
    const int length = std::snprintf(fixed.data(), fixed.size(), "%.*f", decimals, value);
    const bool shorter = static_cast<std::size_t>(length) <= std::strlen(digits.data());
    return shorter ? fixed.data() : digits.data();
}
#else
inline std::string number_text(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}
#endif

}  // namespace cdprep
