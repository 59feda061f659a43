// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/exact/triangles.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// Returns whether the two triangles have a common point. Exact; the sign test of Guigue and
/// Devillers (2003), with exact planar and degenerate cases.
[[nodiscard]] CDPREP_API bool triangles_touch(const Corners& a, const Corners& b) noexcept;

/// Returns the same answer by the six segment-triangle tests of Feito and Torres. An independent
/// second implementation; tests compare the first with it.
[[nodiscard]] CDPREP_API bool triangles_touch_by_segments(const Corners& a,
                                                          const Corners& b) noexcept;

/// Returns how two triangles meet where the signs of a few determinants in double prove it:
/// disjoint or crossing. Returns nothing for triangles that touch, are degenerate or nearly touch.
[[nodiscard]] CDPREP_API std::optional<TriangleContact> contact_by_filter(
    const Corners& a, const Corners& b) noexcept;

/// Returns the answer of classify_contact() without calling contact_by_filter() first. Uses machine
/// integers where all coordinates fit, otherwise expansions.
[[nodiscard]] CDPREP_API TriangleContact contact_beyond_filter(const Corners& a,
                                                               const Corners& b) noexcept;

/// Returns whether a corner of each is the same point; then the two at least touch.
[[nodiscard]] CDPREP_API bool share_a_corner(const Corners& a, const Corners& b) noexcept;

/// Returns how two triangles meet. Exact. A degenerate triangle has no inside: it can only touch.
[[nodiscard]] CDPREP_API TriangleContact classify_contact(const Corners& a,
                                                          const Corners& b) noexcept;

/// Returns the edges that bound the common segment of two triangles that touch. Returns nothing
/// when both lie in one plane or one has no area. Exact.
[[nodiscard]] std::optional<CrossingEnds> crossing_ends(const Corners& a,
                                                        const Corners& b) noexcept;

/// Returns whether the corners are exactly collinear.
[[nodiscard]] bool is_degenerate(const Corners& a) noexcept;

}  // namespace cdprep
