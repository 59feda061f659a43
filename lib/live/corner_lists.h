// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cdprep/format/geometry.h"
#include "core/carver.h"

namespace cdprep {

/// For each vertex, the corners of triangles that lie at it. A list of any length is changed in
/// O(1) time.
class CornerLists {
public:
    CornerLists(Carver& carver, std::size_t vertices, std::size_t triangles) noexcept
        : first_(carver.take<std::uint32_t>(vertices)),
          next_(carver.take<std::uint32_t>(3 * triangles)),
          previous_(carver.take<std::uint32_t>(3 * triangles)) {
        if (first_ != nullptr) std::fill_n(first_, vertices, kNone);
    }

    /// Adds the corners of the triangle at a place of the tree order.
    void add(std::uint32_t place, const format::Triangle& triangle) noexcept {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = 3 * place + k;
            std::uint32_t& first = first_[triangle.vertex[k]];
            next_[corner] = first;
            previous_[corner] = kNone;
            if (first != kNone) previous_[first] = corner;
            first = corner;
        }
    }

    /// Removes the corners that add() added.
    void remove(std::uint32_t place, const format::Triangle& triangle) noexcept {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = 3 * place + k;
            const std::uint32_t before = previous_[corner];
            const std::uint32_t after = next_[corner];
            (before == kNone ? first_[triangle.vertex[k]] : next_[before]) = after;
            if (after != kNone) previous_[after] = before;
        }
    }

    [[nodiscard]] bool is_used(std::uint32_t vertex) const noexcept {
        return first_[vertex] != kNone;
    }

    /// Calls visit(place) for the triangles at a vertex. A triangle with two corners there is
    /// visited twice.
    template <class Visit>
    void each_at(std::uint32_t vertex, Visit&& visit) const {
        for (std::uint32_t c = first_[vertex]; c != kNone; c = next_[c]) visit(c / 3);
    }

private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    std::uint32_t* first_;     ///< by vertex: a corner, or kNone
    std::uint32_t* next_;      ///< by corner
    std::uint32_t* previous_;  ///< by corner
};

}  // namespace cdprep
