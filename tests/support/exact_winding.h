// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "exact/triangle_contact.h"

namespace cdprep::test {

/// The winding number of a closed surface around q, or nothing when q lies on a
/// triangle. Counts what a ray crosses, in exact numbers; a ray that meets an
/// edge or a corner is thrown away and another drawn.
[[nodiscard]] std::optional<int> exact_winding(std::span<const Corners> surface, const Double3& q);

}  // namespace cdprep::test
