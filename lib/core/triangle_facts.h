// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
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

/// Returns whether a place of the tree order has a triangle. Only models that can tear have places
/// without one.
inline bool has_triangle(const Model& model, std::uint32_t place) noexcept {
    if (place >= model.triangle_count()) return false;
    const auto lanes = model.bvh().lanes;
    return lanes.empty() ||
           ((lanes[place / format::kBvhWidth] >> (place % format::kBvhWidth)) & 1) != 0;
}

/// Calls visit(place) for the triangles from `first` up to `last`. Stops and returns false when
/// `visit` returns false.
template <class Visit>
bool each_triangle(const Model& model, std::uint32_t first, std::uint32_t last,
                   Visit&& visit) noexcept {
    const bool all = model.bvh().lanes.empty();
    for (std::uint32_t i = first; i < last; ++i) {
        if ((all || has_triangle(model, i)) && !visit(i)) return false;
    }
    return true;
}

/// The same for the triangles of a leaf.
template <class Visit>
bool each_in_leaf(const Model& model, std::uint32_t leaf, Visit&& visit) noexcept {
    const std::uint32_t first = leaf * format::kBvhWidth;
    return each_triangle(model, first, std::min(first + format::kBvhWidth, model.triangle_count()),
                         visit);
}

}  // namespace cdprep
