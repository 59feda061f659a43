// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/api.h"

namespace cdprep::build {

/// Fits a BVH to new positions of its triangles, and keeps their order. Returns the new
/// surface_cost().
///
/// The result equals that of a build that puts the triangles in the same order. The frame is that
/// of the new positions. Boxes are rounded outwards, so they contain their triangles.
/// Bvh::exact_leaves is set anew. The result depends neither on the old positions nor on
/// options.parallel_for. Oriented boxes and swept spheres are computed anew if options.bounds
/// includes them, otherwise dropped. Ignores options.quality.
///
/// `bvh` must come from build_bvh() or rebuild_bvh() over `triangles`. With another number of
/// triangles, the program stops with a message. `positions` must meet the requirements of
/// build_bvh(). The order stays efficient as long as neighbouring triangles stay
/// neighbours. The returned cost shows when to rebuild:
///
///     double cost = refit_bvh(bvh, positions, triangles);
///     if (cost > 1.5 * cost_when_built) {
///         rebuild_bvh(bvh, positions, triangles, {.quality = Quality::fast});
///         cost_when_built = surface_cost(bvh);
///     }
///
/// Takes O(n) time. A repeated call with the same options allocates nothing with
/// BvhBounds::aligned. With other bounds, it allocates 80 bytes per 4,096 triangles.
CDPREP_API double refit_bvh(Bvh& bvh, std::span<const format::Double3> positions,
                            std::span<const format::Triangle> triangles,
                            const BvhOptions& options = {});

}  // namespace cdprep::build
