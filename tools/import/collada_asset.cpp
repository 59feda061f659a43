// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/collada_asset.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "import/parse_number.h"

namespace cdprep::import {
namespace {

// Searches the text instead of parsing it: the child parses such files whole, and they are large.

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// Returns the text after `before`; empty if `before` is missing.
std::string_view after(std::string_view text, std::string_view before) {
    const std::size_t first = text.find(before);
    return text.substr(first == std::string_view::npos ? text.size() : first + before.size());
}

/// Returns the value of an attribute; empty if the tag lacks it. `tag` begins after the name of the
/// tag. Values have either quote, and blanks may surround the equals sign.
std::string_view attribute(std::string_view tag, std::string_view name) {
    constexpr std::size_t kNone = std::string_view::npos;
    for (;;) {
        const std::size_t equals = tag.find_first_of("=>");
        if (equals == kNone || tag[equals] == '>') return {};
        const std::size_t quote = tag.find_first_not_of(kBlanks, equals + 1);
        if (quote == kNone || (tag[quote] != '"' && tag[quote] != '\'')) return {};
        const std::size_t last = tag.find(tag[quote], quote + 1);
        if (last == kNone) return {};
        if (trimmed(tag.substr(0, equals)) == name) return tag.substr(quote + 1, last - quote - 1);
        tag.remove_prefix(last + 1);
    }
}

double metres_of(std::string_view unit) {
    const std::string_view text = trimmed(attribute(unit, "meter"));
    const Number number = parse_number(text.data(), text.data() + text.size());
    return number.next && std::isfinite(number.value) && number.value > 0 ? number.value : 1;
}

constexpr std::size_t kAssetBytes = 65536;  ///< the asset is the first element

bool is_collada(std::string_view bytes) {
    return bytes.substr(0, kAssetBytes).find("<COLLADA") != std::string_view::npos;
}

format::UpAxis axis_named(std::string_view name) {
    if (name.find("X_UP") != std::string_view::npos) return format::UpAxis::x;
    return name.find("Z_UP") != std::string_view::npos ? format::UpAxis::z : format::UpAxis::y;
}

}  // namespace

void add_collada_asset(std::string_view bytes, mesh::TriangleSoup& soup) {
    if (!is_collada(bytes)) return;
    const std::string_view start = bytes.substr(0, kAssetBytes);
    const std::string_view asset = start.substr(0, start.find("</asset>"));
    soup.metres_per_unit = metres_of(after(asset, "<unit"));
    const std::string_view axis = after(after(asset, "<up_axis"), ">");
    soup.up_axis = axis_named(axis.substr(0, axis.find('<')));
}

std::string find_outside_reference(std::string_view bytes) {
    if (!is_collada(bytes)) return {};
    for (const std::string_view element :
         {"<instance_geometry", "<instance_node", "<instance_controller"}) {
        for (std::size_t at = bytes.find(element); at != std::string_view::npos;
             at = bytes.find(element, at + 1)) {
            const std::string_view url = attribute(bytes.substr(at + element.size()), "url");
            if (!url.empty() && url.front() != '#') return std::string(url);
        }
    }
    return {};
}

}  // namespace cdprep::import
