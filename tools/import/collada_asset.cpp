// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/collada_asset.h"

#include <cmath>
#include <string>

#include "import/parse_number.h"

namespace cdprep::import {
namespace {

// Searches the text instead of parsing it: the child parses such files whole, and they are large.

/// Returns the text between `before` and the next `after`; empty if `before` is missing.
std::string_view between(std::string_view text, std::string_view before, char after) {
    const std::size_t first = text.find(before);
    if (first == std::string_view::npos) return {};
    text.remove_prefix(first + before.size());
    return text.substr(0, text.find(after));
}

double metres_of(std::string_view unit) {
    for (const char quote : {'"', '\''}) {
        const std::string_view text = between(unit, std::string("meter=") + quote, quote);
        const Number number = parse_number(text.data(), text.data() + text.size());
        if (number.next && std::isfinite(number.value) && number.value > 0) return number.value;
    }
    return 1;
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
    soup.metres_per_unit = metres_of(between(asset, "<unit", '>'));
    soup.up_axis = axis_named(between(asset, "<up_axis>", '<'));
}

std::string find_outside_reference(std::string_view bytes) {
    if (!is_collada(bytes)) return {};
    for (const std::string_view element :
         {"<instance_geometry", "<instance_node", "<instance_controller"}) {
        for (std::size_t at = bytes.find(element); at != std::string_view::npos;
             at = bytes.find(element, at + 1)) {
            const std::string_view tag = bytes.substr(at, bytes.find('>', at) - at);
            for (const char quote : {'"', '\''}) {
                const std::string_view url = between(tag, std::string("url=") + quote, quote);
                if (!url.empty() && url.front() != '#') return std::string(url);
            }
        }
    }
    return {};
}

}  // namespace cdprep::import
