// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cells/cone_children.h"

namespace cdprep::build {

inline constexpr std::uint32_t kMostLevelAtOnce = 3;  ///< 512 cones

/// All triangles, by the cones of one level that they touch.
struct ConeLists {
    std::unique_ptr<std::uint32_t[]> items;  ///< rising in each cone; and kSharedReference
    std::vector<std::size_t> first;          ///< by key: where each cone's begin; then the end
    std::vector<std::uint32_t> centre;       ///< triangles that hold the centre: in no cone
};

/// Sorts the triangles into the cones of a level, at most kMostLevelAtOnce, without the lists
/// of the levels above. home[i] is the deepest cone that certainly holds triangle i inside,
/// or 0. The same for any parallel_for. Scratch: 2 bytes a triangle, and half a byte for the
/// counts of each cone in each task; 4 bytes for each cone that one in several touches.
[[nodiscard]] ConeLists split_at_once(const TetraInput& input, const std::uint32_t* home,
                                      std::uint32_t level, ParallelFor parallel_for);

}  // namespace cdprep::build
