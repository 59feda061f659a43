// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "exact/triangle_contact.h"

namespace cdprep::test {

/// Returns the winding number of a closed surface around q, or nothing if q lies on a triangle.
/// Counts the crossings of a ray, in exact numbers. A ray that meets an edge or a corner is
/// discarded for another random ray.
[[nodiscard]] std::optional<int> exact_winding(std::span<const Corners> surface, const Double3& q);

}  // namespace cdprep::test
