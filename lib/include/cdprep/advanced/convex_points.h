// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/api.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/hull.h"

namespace cdprep {

using format::Double3;

/// The corners of a convex hull in the form that queries read. The caller owns the memory behind
/// all spans, such as a mapped file.
///
/// The hull is that of the points and may have any dimension; a single point is allowed. Without
/// neighbours, points that are not corners are allowed too.
struct ConvexPoints {
    std::span<const format::HullBlock> blocks;  ///< ceil(count / 8); unused lanes as in HullBlock
    std::uint32_t count = 0;                    ///< points, >= 1; queries state the meaning of 0
    Double3 reach{};  ///< at least the largest |x|, |y|, |z| of all points, model units
    /// count + 1 indices in `neighbours`, or empty. The neighbours of point i begin at element i
    /// and end before element i + 1. If empty, queries search all points for the farthest one,
    /// which is best for fewer than kClimbFrom points.
    std::span<const std::uint32_t> neighbour_begins;
    /// The numbers of the points at the other ends of each point's edges. The edges are those of
    /// the exact hull, including the diagonals between coplanar facets. A point that is farther
    /// along a direction than all its neighbours must be the farthest of all points.
    std::span<const std::uint32_t> neighbours;
    /// Empty, or for each direction_cell() the number of a point that is far along its directions.
    /// Any point gives the correct result. A point near the farthest one saves steps.
    std::span<const std::uint32_t> starts;
    /// Used instead of `blocks` for hulls with few points, whose `neighbours` are empty. Point i is
    /// floats[corners[i]] or, if `floats` is empty, doubles[corners[i]].
    std::span<const std::uint32_t> corners{};
    std::span<const format::Float3> floats{};
    std::span<const Double3> doubles{};

    /// Returns point `number`, which must be below `count`.
    [[nodiscard]] CDPREP_API Double3 point(std::uint32_t number) const noexcept;
};

/// Returns points in the form of ConvexPoints::blocks; lanes past the last point repeat it.
/// Allocates.
[[nodiscard]] CDPREP_API std::vector<format::HullBlock> hull_blocks(
    std::span<const Double3> points);

/// The minimum point count for hill climbing along hull edges.
inline constexpr std::uint32_t kClimbFrom = 64;

/// Directions are classified by cells on the faces of a cube around the origin. This is the number
/// of cells along each edge of the cube.
inline constexpr std::uint32_t kDirectionCells = 8;
/// The length of ConvexPoints::starts.
inline constexpr std::uint32_t kDirectionStarts = 6 * kDirectionCells * kDirectionCells;

/// Returns the number of the cell that a direction hits, less than kDirectionStarts. The cells
/// divide the faces of a cube around the origin. They are numbered face by face (+x, -x, +y, -y,
/// +z, -z), and within a face row by row. On the faces +x and -x, the cells of a row are in
/// ascending order of y. The rows are in ascending order of z. The cells of the other faces are
/// numbered likewise, with the axes in cyclic order. The coordinate of largest magnitude selects
/// the face; of several, the first does. The direction must be finite. The zero vector has a cell
/// too.
[[nodiscard]] CDPREP_API std::uint32_t direction_cell(const Double3& direction) noexcept;

}  // namespace cdprep
