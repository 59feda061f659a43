// SPDX-License-Identifier: MIT
#pragma once

#include "core/moved_model.h"

namespace cdprep {

/// Returns the part of a box that is child `child` of a format::AdaptiveOctreeNode. It is above the
/// split point along x, y, z where bits 0, 1, 2 are set, below it otherwise.
inline Box3 split_box(const Box3& box, const Double3& split, std::size_t child) noexcept {
    const auto& [lower, upper] = box;
    const bool x = (child & 1) != 0, y = (child & 2) != 0, z = (child & 4) != 0;
    return {{x ? split.x : lower.x, y ? split.y : lower.y, z ? split.z : lower.z},
            {x ? upper.x : split.x, y ? upper.y : split.y, z ? upper.z : split.z}};
}

}  // namespace cdprep
