// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_points.h"

#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "hull/hull_points.h"

namespace cdprep {

std::vector<format::HullBlock> hull_blocks(std::span<const Double3> points) {
    std::vector<format::HullBlock> blocks((points.size() + format::kHullLanes - 1) /
                                          format::kHullLanes);
    for (std::size_t i = 0; i < blocks.size() * format::kHullLanes; ++i) {
        const Double3& p = points[std::min(i, points.size() - 1)];
        auto& at = blocks[i / format::kHullLanes].at;
        at[0][i % format::kHullLanes] = p.x;
        at[1][i % format::kHullLanes] = p.y;
        at[2][i % format::kHullLanes] = p.z;
    }
    return blocks;
}

Double3 ConvexPoints::point(std::uint32_t number) const noexcept {
    const format::FloatEnvironment environment;
    return hull_point(*this, number);
}

std::uint32_t direction_cell(const Double3& direction) noexcept {
    const format::FloatEnvironment environment;
    return cell_of_direction(direction);
}

}  // namespace cdprep
