// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "exact/triangle_contact.h"
#include "exact/winding.h"

namespace cdprep::test {

/// Returns the winding number of a balanced surface around q, or nothing if q lies on a triangle.
/// Counts the crossings of a ray, in exact numbers. A ray that meets an edge or a corner is
/// discarded for another random ray.
[[nodiscard]] std::optional<int> exact_winding(std::span<const Corners> surface, const Double3& q);

/// Returns the sum of winding_term() over a surface, or nothing if q lies on a triangle.
[[nodiscard]] inline std::optional<int> sum_of_terms(std::span<const Corners> surface,
                                                     const Double3& origin, const Double3& q) {
    int sum = 0;
    for (const Corners& t : surface) {
        const WindingTerm term = winding_term(origin, q, t);
        if (term.on_surface) return std::nullopt;
        sum += term.crossings;
    }
    return sum;
}

}  // namespace cdprep::test
