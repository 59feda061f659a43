// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/exact/triangles.h"

namespace cdprep {

/// Returns whether the two triangles have a common point. Exact; the sign test
/// of Guigue and Devillers (2003), with exact planar and degenerate cases.
[[nodiscard]] bool triangles_touch(const Corners& a, const Corners& b) noexcept;

/// The same answer, by the six segment-triangle tests of Feito and Torres: an
/// independent second implementation that the first is held against.
[[nodiscard]] bool triangles_touch_by_segments(const Corners& a, const Corners& b) noexcept;

/// Returns how the two stand where the signs of a few determinants in double leave no
/// doubt: apart, or crossing. Nothing for all that touches, is flat or comes near.
[[nodiscard]] std::optional<TriangleContact> contact_by_filter(const Corners& a,
                                                               const Corners& b) noexcept;

/// Returns what classify_contact() does, without asking contact_by_filter() first: in
/// machine integers where all coordinates fit, in expansions where not.
[[nodiscard]] TriangleContact contact_beyond_filter(const Corners& a, const Corners& b) noexcept;

/// True when a corner of each is the same point: then the two touch, at least.
[[nodiscard]] bool share_a_corner(const Corners& a, const Corners& b) noexcept;

/// Returns how the two stand. Exact. A degenerate triangle has no inside: it can
/// only touch.
[[nodiscard]] TriangleContact classify_contact(const Corners& a, const Corners& b) noexcept;

/// Returns what bounds the common segment of two triangles that touch, or nothing when
/// both lie in one plane or one has no area. Exact.
[[nodiscard]] std::optional<CrossingEnds> crossing_ends(const Corners& a,
                                                        const Corners& b) noexcept;

/// True when the corners are exactly collinear.
[[nodiscard]] bool is_degenerate(const Corners& a) noexcept;

}  // namespace cdprep
