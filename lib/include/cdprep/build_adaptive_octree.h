// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"
#include "cdprep/format/octree.h"
#include "cdprep/parallel_for.h"

namespace cdprep::build {

/// An octree whose nodes choose their split points, as format/octree.h has it.
struct AdaptiveOctree {
    format::AdaptiveOctree tree{};
    std::vector<format::AdaptiveOctreeNode> nodes;
    std::vector<std::uint32_t> references;
};

struct AdaptiveOctreeOptions {
    ParallelFor parallel_for = serial_for;
    std::uint32_t level = 3;      ///< no cell is deeper; 0 to format::kOctreeBits
    std::uint32_t threshold = 1;  ///< a cell with fewer triangles is not divided; 1 at least
    format::SplitRule rule = format::SplitRule::median;
};

/// Builds it, as build_octree() does: exact closed cells, deterministic.
[[nodiscard]] AdaptiveOctree build_adaptive_octree(std::span<const format::Double3> positions,
                                                   std::span<const format::Triangle> triangles,
                                                   const AdaptiveOctreeOptions& options = {});

}  // namespace cdprep::build
