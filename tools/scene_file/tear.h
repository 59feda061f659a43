// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/live_model.h"

namespace cdprep::scenes {

using format::Double3;

/// A cut of a model along a plane, in the coordinates of the model at rest. The far side is that
/// to which the normal points.
struct Tear {
    std::array<double, 3> point{};
    std::array<double, 3> normal = {0, 0, 1};  ///< of any length but 0
    double time_s = 0;                         ///< the first frame from this time on is torn
    double opening = 0;                        ///< the way between the two sides, at least 0

    auto operator<=>(const Tear&) const = default;
};

/// Returns the side of a point: -1 near, 0 on the plane, 1 far. Coordinates are at most
/// format::kMaxCoordinate. The result is exact if coordinates that are not 0 differ by a factor of
/// at most 2^450. The same must hold for those of the normal.
[[nodiscard]] int side_of(const Tear& tear, const Double3& point) noexcept;

/// Returns how far the far side moves. The near side moves as far the other way.
[[nodiscard]] Double3 half_opening(const Tear& tear) noexcept;

/// A new vertex of a cut, on an edge of the model at rest: at `a` + `share` * (`b` - `a`). Copies
/// of a vertex in the plane have a = b.
struct CutVertex {
    std::uint32_t a;
    std::uint32_t b;
    double share;
};

/// The changes of a cut. All lists are empty if the plane misses the model.
struct Cut {
    std::vector<std::uint32_t> removed;      ///< numbers of triangles, rising
    std::vector<format::Triangle> appended;  ///< triangles in their place
    std::vector<CutVertex> vertices;         ///< numbered from the number of `rest` on
    std::vector<std::uint8_t> is_far;        ///< for each vertex, the new ones at the end
    bool misses = true;
};

/// Cuts triangles along the plane of a tear. `rest` has the positions of the vertices by number.
///
/// A triangle with vertices on both sides crosses the plane. It is replaced by fragments: two if a
/// vertex is in the plane, otherwise three. Each edge that crosses gets one new vertex for each
/// side. Its position is rounded, its side is not: fragments belong to the side of their old
/// vertices.
///
/// Vertices in the plane are found exactly. A triangle that touches the plane belongs to the side
/// of its other vertices. One that lies in the plane belongs to the near side. If both sides use a
/// vertex in the plane, the far side gets a copy. Its triangles there are replaced as well. All
/// other triangles keep their numbers.
///
/// The plane misses the model unless triangles have vertices on both sides of it. It may part a
/// model without crossing a triangle.
[[nodiscard]] Cut cut_by_plane(std::span<const Double3> rest,
                               std::span<const LiveTriangle> triangles, const Tear& tear);

}  // namespace cdprep::scenes
