// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/octree.h"
#include "core/moved_model.h"

namespace cdprep::build {

/// What is known of a cell that is to be divided.
struct CellContent {
    Box3 box;
    /// Of the triangles that touch it, numbers into `boxes`, perhaps with
    /// format::kSharedReference.
    std::span<const std::uint32_t> list;
    std::span<const Box3> boxes;  ///< around each triangle
};

/// Where a cell may be divided along one axis.
struct AxisSplit {
    double plane;    ///< strictly inside the cell's box; its upper bound where nothing is
    bool separates;  ///< some triangle's box lies strictly to one side
};

/// Chooses it.
///
/// Median: of the middles of the triangles' boxes, each cut to the cell; where that is on
/// the cell's border, because most lie flat on it, the middle of the cell. Surface area:
/// of the 15 planes between 16 slices of equal width the one with the least sum, over
/// both sides, of area times triangles; of equal ones the nearest to the middle.
/// `scratch` is for the median: a double per triangle of the list.
[[nodiscard]] AxisSplit choose_split(const CellContent& cell, std::size_t axis,
                                     format::SplitRule rule, std::vector<double>& scratch);

}  // namespace cdprep::build
