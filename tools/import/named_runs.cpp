// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/named_runs.h"

#include <cstddef>
#include <unordered_map>

namespace cdprep::import {
namespace {

/// Returns the length of the well-formed UTF-8 sequence at the front of `text`, or 0.
/// Overlong forms, surrogates and numbers past U+10FFFF are not well-formed.
std::size_t utf8_length(std::string_view text) noexcept {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return 0;
    }
    const unsigned char second = byte(1);
    const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
    const bool outside = (lead == 0xed && second >= 0xa0) || (lead == 0xf4 && second >= 0x90);
    return overlong || outside ? 0 : length;
}

/// Numbers names in the order of their first use.
class NameNumbers {
public:
    explicit NameNumbers(std::vector<std::string>& names) : names_(names) {}

    std::uint32_t number_of(std::string_view name) {
        const auto next = static_cast<std::uint32_t>(names_.size());
        const auto [found, is_new] = numbers_.try_emplace(std::string(name), next);
        if (is_new) names_.emplace_back(name);
        return found->second;
    }

private:
    std::vector<std::string>& names_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

}  // namespace

mesh::NamedRuns named_runs(std::span<const NamedStart> starts, std::uint32_t triangle_count,
                           std::string_view default_name) {
    mesh::NamedRuns result;
    if (starts.empty() || triangle_count == 0) return result;
    NameNumbers numbers(result.names);
    const auto add = [&](std::uint32_t first, std::uint32_t last, std::string_view name) {
        if (first == last) return;
        const std::uint32_t number = numbers.number_of(name);
        if (!result.runs.empty() && result.runs.back().name == number) {
            result.runs.back().triangle_count += last - first;
        } else {
            result.runs.push_back({first, last - first, number, 0});
        }
    };
    add(0, starts.front().first_triangle, default_name);
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const std::uint32_t last =
            i + 1 < starts.size() ? starts[i + 1].first_triangle : triangle_count;
        add(starts[i].first_triangle, last, starts[i].name);
    }
    return result;
}

std::string utf8_name(std::string_view text) {
    std::string name;
    name.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const auto first = static_cast<unsigned char>(text.front());
        if (length == 0 || first < ' ' || first == 0x7f) {
            name += "\xef\xbf\xbd";
            text.remove_prefix(1);
        } else {
            name += text.substr(0, length);
            text.remove_prefix(length);
        }
    }
    return name;
}

}  // namespace cdprep::import
