// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"
#include "cdprep/format/hull.h"

namespace cdprep {

/// Points as ConvexPoints::blocks has them: lanes past the last one repeat it.
[[nodiscard]] inline std::vector<format::HullBlock> blocks_of(
    std::span<const format::Double3> points) {
    std::vector<format::HullBlock> blocks((points.size() + format::kHullLanes - 1) /
                                          format::kHullLanes);
    for (std::size_t i = 0; i < blocks.size() * format::kHullLanes; ++i) {
        const format::Double3& p = points[std::min(i, points.size() - 1)];
        auto& at = blocks[i / format::kHullLanes].at;
        at[0][i % format::kHullLanes] = p.x;
        at[1][i % format::kHullLanes] = p.y;
        at[2][i % format::kHullLanes] = p.z;
    }
    return blocks;
}

}  // namespace cdprep
