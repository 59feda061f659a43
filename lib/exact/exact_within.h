// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "exact/triangle_contact.h"

namespace cdprep {

/// Returns whether a point, segment or triangle is at most `distance` from a triangle; equal
/// counts. One to three corners define the first object. Exact for all finite numbers, subnormals
/// included. Corners may be collinear or equal. False for a negative distance or NaN. Never
/// allocates; takes about 20 KiB of stack.
///
/// Double decides most cases. Integers decide the rest, which takes microseconds.
[[nodiscard]] bool is_within_exactly(std::span<const Double3> points, const Corners& t,
                                     double distance) noexcept;

/// Runs the integer stage alone, for objects that do not touch. Serves tests, and callers that have
/// tried the other stages.
[[nodiscard]] bool is_within_in_integers(std::span<const Double3> points, const Corners& t,
                                         double distance) noexcept;

}  // namespace cdprep
