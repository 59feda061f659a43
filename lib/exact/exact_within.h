// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "exact/triangle_contact.h"

namespace cdprep {

/// Returns whether a point, segment or triangle, given by its 1 to 3 corners, and a
/// triangle are at most `distance` apart: exactly, for all finite numbers, subnormals
/// included; equal counts. Corners may be collinear or equal. False for a negative
/// distance or NaN. Never allocates; takes some 20 KiB of stack.
///
/// In double first; what that leaves open is decided in integers, which takes
/// microseconds.
[[nodiscard]] bool is_within_exactly(std::span<const Double3> points, const Corners& t,
                                     double distance) noexcept;

/// The stage in integers alone, for two that do not touch: for tests and callers
/// that have tried the others.
[[nodiscard]] bool is_within_in_integers(std::span<const Double3> points, const Corners& t,
                                         double distance) noexcept;

}  // namespace cdprep
