// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/model.h"

namespace cdprep {

/// Returns a triangle's number in the imported file, or in the tree order if that section is
/// absent.
inline std::uint32_t source_number(const Model& model, std::uint32_t triangle) noexcept {
    const auto source = model.source().triangle;
    return source.empty() ? triangle : source[triangle];
}

inline bool is_marked_degenerate(const Model& model, std::uint32_t triangle) noexcept {
    const auto bits = model.mesh().degenerate_bits;
    return !bits.empty() && ((bits[triangle / 64] >> (triangle % 64)) & 1) != 0;
}

}  // namespace cdprep
