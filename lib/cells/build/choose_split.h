// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/octree.h"
#include "core/moved_model.h"

namespace cdprep::build {

/// The contents of a cell that is to be divided.
struct CellContent {
    Box3 box;
    /// The triangles that touch the cell: numbers into `boxes`, perhaps with
    /// format::kSharedReference.
    std::span<const std::uint32_t> list;
    std::span<const Box3> boxes;  ///< around each triangle
};

/// A plane at which a cell may be divided along one axis.
struct AxisSplit {
    double plane;    ///< strictly inside the cell's box; its upper bound if nothing is inside
    bool separates;  ///< some triangle's box lies strictly to one side
};

/// Chooses the plane at which to divide a cell along one axis.
///
/// Median: the median of the middles of the triangles' boxes, each cut to the cell. If that is on
/// the cell's border, because most triangles lie flat on it, the middle of the cell. Surface area:
/// of the 15 planes between 16 slices of equal width, the one with the least sum, over both sides,
/// of area times triangles. Of equal planes, the nearest to the middle. `scratch` is for the
/// median: a double per triangle of the list.
[[nodiscard]] AxisSplit choose_split(const CellContent& cell, std::size_t axis,
                                     format::SplitRule rule, std::vector<double>& scratch);

}  // namespace cdprep::build
