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

/// The corners of a convex hull in the form that queries read. The caller owns all spans, such as
/// those of a mapped file.
///
/// The hull is that of the points and may have any dimension; a single point is allowed. Without
/// neighbours, points that are not corners are allowed too.
struct ConvexPoints {
    std::span<const format::HullBlock> blocks;  ///< ceil(count / 8); HullBlock states how they end
    std::uint32_t count = 0;                    ///< of points, >= 1; queries state the meaning of 0
    Double3 reach{};  ///< at least the largest |x|, |y|, |z| of all points, model units
    /// count + 1 places in `neighbours`, or empty. If empty, the farthest point is sought among all
    /// points, which is best for fewer than kClimbFrom.
    std::span<const std::uint32_t> neighbour_begins;
    /// The numbers of the points at the other ends of each point's edges. They are the exact hull
    /// edges, including the diagonals between coplanar facets. A point that is higher than all its
    /// neighbours must be the highest.
    std::span<const std::uint32_t> neighbours;
    /// For each direction_cell(), a point that is far in its directions; or empty. Any point gives
    /// the correct result. A point near the farthest one saves steps.
    std::span<const std::uint32_t> starts;
    /// An alternative to blocks, for hulls of few points and without neighbours. Point i is number
    /// corners[i] of `floats` or, if that is empty, of `doubles`.
    std::span<const std::uint32_t> corners{};
    std::span<const format::Float3> floats{};
    std::span<const Double3> doubles{};

    /// Returns the point with a number below `count`.
    [[nodiscard]] Double3 point(std::uint32_t number) const noexcept;
};

/// Returns points in the form of ConvexPoints::blocks; lanes past the last one repeat it.
/// Allocates.
[[nodiscard]] std::vector<format::HullBlock> hull_blocks(std::span<const Double3> points);

/// The minimum point count for hill climbing along hull edges.
inline constexpr std::uint32_t kClimbFrom = 64;

/// The number of cells along each edge of the cube around a hull that classifies directions.
inline constexpr std::uint32_t kDirectionCells = 8;
/// The length of ConvexPoints::starts.
inline constexpr std::uint32_t kDirectionStarts = 6 * kDirectionCells * kDirectionCells;

/// Returns the cell of the cube's faces at which a direction points, below kDirectionStarts. The
/// faces are +x, -x, +y, -y, +z, -z. A face has rows along the axis after next and columns along
/// the next axis, both rising. Of several largest coordinates the first counts. The direction must
/// be finite. The zero vector is in some cell.
[[nodiscard]] std::uint32_t direction_cell(const Double3& direction) noexcept;

}  // namespace cdprep
