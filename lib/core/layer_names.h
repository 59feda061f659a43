// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace cdprep {

/// Returns a layer as sentences name it: by its name in quotes, or by its number if it has none.
template <class Names>
[[nodiscard]] std::string layer_text(const Names& names, std::uint32_t layer) {
    if (layer >= names.size() || names[layer].empty()) return std::to_string(layer);
    std::string text = "'";
    text += names[layer];
    return text + "'";
}

/// Returns two layers: "'crates' and 'floor'".
template <class Names>
[[nodiscard]] std::string layers_text(const Names& names, std::uint32_t a, std::uint32_t b) {
    return layer_text(names, a) + " and " + layer_text(names, b);
}

}  // namespace cdprep
