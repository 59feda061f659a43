// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"
#include "cdprep/format/hull.h"

namespace cdprep {

using format::Double3;

/// The corners of a convex hull as queries want them. All spans are the caller's (a
/// mapped file's).
///
/// The hull is that of the points: of any dimension, a single point included. Points that
/// are no corners are allowed where there are no neighbours.
struct ConvexPoints {
    std::span<const format::HullBlock> blocks;  ///< ceil(count / 8); see there how it ends
    std::uint32_t count = 0;                    ///< of points, >= 1; queries say what 0 means
    Double3 reach{};  ///< at least the largest |x|, |y|, |z| of any point, model units
    /// count + 1 places in `neighbours`, or empty: then the farthest point is sought among
    /// all, which is best for fewer than kClimbFrom points.
    std::span<const std::uint32_t> neighbour_begins;
    /// Numbers of the points at the other ends of a point's edges: exact hull edges,
    /// diagonals of coplanar facets included. A point that is higher than all its
    /// neighbours must be the highest.
    std::span<const std::uint32_t> neighbours;
    /// For each direction_cell() a point that is far in its directions, or empty. Any point
    /// is right; a good one saves steps.
    std::span<const std::uint32_t> starts;
    /// Instead of blocks, for hulls of few points: point i is number corners[i] of `floats` or,
    /// where those are empty, of `doubles`. Without neighbours.
    std::span<const std::uint32_t> corners{};
    std::span<const format::Float3> floats{};
    std::span<const Double3> doubles{};

    /// Returns the point of a number below `count`.
    [[nodiscard]] Double3 point(std::uint32_t number) const noexcept;
};

/// Returns points as ConvexPoints::blocks has them: lanes past the last one repeat it. Allocates.
[[nodiscard]] std::vector<format::HullBlock> hull_blocks(std::span<const Double3> points);

/// Points from which on neighbours pay.
inline constexpr std::uint32_t kClimbFrom = 64;

/// Cells along each edge of the cube around a hull on which directions are sorted.
inline constexpr std::uint32_t kDirectionCells = 8;
/// Length of ConvexPoints::starts.
inline constexpr std::uint32_t kDirectionStarts = 6 * kDirectionCells * kDirectionCells;

/// Returns which cell of the cube's faces a direction points at, below kDirectionStarts:
/// faces +x, -x, +y, -y, +z, -z, in each rows of the axis after next and columns of the
/// next axis, rising. Of several largest coordinates the first counts. The direction is
/// finite; 0, 0, 0 is in some cell.
[[nodiscard]] std::uint32_t direction_cell(const Double3& direction) noexcept;

}  // namespace cdprep
