// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// Finds the leaves of A's BVH whose boxes may be at most `reach` from a leaf's box of B. Lengths
/// are in model units. All triangles of other leaves are farther than that from all of B's, for the
/// vertices as transform_point() moves them. Stores the leaves in tree order and returns how many
/// there are. If there are more than `room` holds, it stops and returns one more than that.
/// Requires a reach of at least 0, and that neither model is empty.
[[nodiscard]] std::size_t find_near_leaves(const Model& a, const Model& b,
                                           const Placement& placement, double reach,
                                           std::span<std::uint32_t> room) noexcept;

}  // namespace cdprep
