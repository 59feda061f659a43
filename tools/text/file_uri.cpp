// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/file_uri.h"

#include <array>
#include <string_view>

namespace cdprep::report {
namespace {

/// Returns true for the unreserved characters of RFC 3986 and for the slash that separates folders.
bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-._~/").find(c) != std::string_view::npos;
}

std::string percent_encoded(const std::string& path) {
    constexpr std::array<char, 17> kDigits = {"0123456789ABCDEF"};
    std::string text;
    for (const char c : path) {
        if (is_plain(c)) {
            text += c;
            continue;
        }
        const auto byte = static_cast<unsigned char>(c);
        text += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    }
    return text;
}

}  // namespace

std::string file_uri(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const std::filesystem::path whole = (folder / path).lexically_normal();
    const std::filesystem::path below = whole.lexically_relative(folder.lexically_normal());
    const bool is_below = !below.empty() && *below.begin() != ".." && below != ".";
    return is_below ? percent_encoded(below.string()) : "file://" + percent_encoded(whole.string());
}

}  // namespace cdprep::report
