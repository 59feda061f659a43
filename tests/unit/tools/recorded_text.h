// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <regex>
#include <string>

namespace cdprep::test {

/// The text with at most eight digits of each number: the last ones are the C library's.
inline std::string rounded(const std::string& text) {
    static const std::regex number(R"(\d+\.\d+(e[-+]?\d+)?)");
    std::string result;
    auto end = text.begin();
    for (std::sregex_iterator at(text.begin(), text.end(), number), none; at != none; ++at) {
        std::array<char, 32> digits;
        std::snprintf(digits.data(), digits.size(), "%.8g", std::stod(at->str()));
        result.append(end, (*at)[0].first);
        result += digits.data();
        end = (*at)[0].second;
    }
    return result.append(end, text.end());
}

/// The hash (FNV-1a) that a test records of a text. A change that is meant changes it: read the
/// text that the failure prints, and record the new hash.
inline std::uint64_t hash_of_text(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char letter : rounded(text)) {
        hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
    }
    return hash;
}

}  // namespace cdprep::test
