// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/exact/predicates.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// The contact of two triangles.
enum class TriangleContact : std::uint8_t {
    disjoint,         ///< no common point
    touch,            ///< common points, but no crossing and no shared area
    cross,            ///< their interiors cross; not in one plane
    coplanar_overlap  ///< in one plane, with shared area
};

/// An edge of one triangle that meets the other's plane in one point.
struct PiercingEdge {
    Double3 from;
    Double3 to;
    bool of_a;  ///< an edge of A, else of B
};

/// The edges that contain the two ends of the common segment of two triangles.
struct CrossingEnds {
    PiercingEdge first;
    PiercingEdge second;
    bool is_point;  ///< both ends are one point
};

/// The distance of a point from a triangle.
struct PointTriangleDistance {
    Double3 nearest;  ///< on the triangle, up to rounding
    double computed;  ///< the rounded distance to `nearest`
    double lower;     ///< proven: the exact distance is at least this; >= 0
    double upper;     ///< proven: the exact distance is at most this
};

}  // namespace cdprep

namespace cdprep::exact {

/// Returns whether two triangles have a common point. Exact. Takes some 30 ns where a filter in
/// double decides; microseconds at worst (Guigue and Devillers 2003, with exact signs).
[[nodiscard]] CDPREP_API bool triangles_touch(const Corners& a, const Corners& b) noexcept;

/// Returns how two triangles meet. Exact. A triangle without area has no interior: it can only
/// touch. Costs as much as triangles_touch().
[[nodiscard]] CDPREP_API TriangleContact classify_contact(const Corners& a,
                                                          const Corners& b) noexcept;

/// Returns the result of classify_contact(), computed without the filter. Serves studies of the
/// filter's benefit. Exact.
[[nodiscard]] CDPREP_API TriangleContact contact_without_filter(const Corners& a,
                                                                const Corners& b) noexcept;

/// Returns the edges that bound the common segment of two triangles that touch. Exact. Returns
/// nothing if both lie in one plane or one has no area. If the triangles do not touch, the result
/// has no meaning.
[[nodiscard]] CDPREP_API std::optional<CrossingEnds> crossing_ends(const Corners& a,
                                                                   const Corners& b) noexcept;

/// Returns whether the corners are collinear. Exact.
[[nodiscard]] CDPREP_API bool is_degenerate(const Corners& t) noexcept;

/// Returns the distance of `q` from a triangle, with or without area, as a proven interval.
///
/// Let u = 2^-53, and let M be the distance from `q` to the farthest corner. The width of the
/// interval is usually at most 32 u M. If the triangle is much nearer than that corner, the width
/// is up to 200 u M. For slivers, the interval is wider. Works for all sizes from subnormal numbers
/// to format::kMaxCoordinate. Takes some 50 ns.
[[nodiscard]] CDPREP_API PointTriangleDistance point_triangle_distance(const Double3& q,
                                                                       const Corners& t) noexcept;

/// Returns whether a point, segment or triangle is at most `distance` from the triangle `t`;
/// inclusive. `corners` are the 1 to 3 corners of the point, segment or triangle: with another
/// number, the program stops with a message. Exact. Returns false for a negative distance or NaN.
/// Takes microseconds where double does not decide, and some 20 KiB of stack.
[[nodiscard]] CDPREP_API bool is_within(std::span<const Double3> corners, const Corners& t,
                                        double distance) noexcept;

}  // namespace cdprep::exact
