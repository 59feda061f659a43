// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/build_bvh.h"

namespace cdprep::build {

/// Moves a hierarchy along with its triangles: new positions, the same order. Returns
/// its surface_cost() now.
///
/// Everything is what a build that came to this order would have made: the frame is
/// that of the new positions, boxes hold their triangles in exact arithmetic again,
/// leaves are exact where all coordinates are floats. It does not depend on what the
/// positions were, nor on options.parallel_for. Oriented boxes are fitted anew or, without
/// options.oriented, dropped. options.quality does not matter.
///
/// `bvh` must come from build_bvh() or rebuild_bvh() over `triangles`; positions are
/// as there. The order is as good as when it was built for motions that leave
/// neighbours neighbours; the cost, kept from the build, tells when to rebuild:
///
///     double cost = refit_bvh(bvh, positions, triangles);
///     if (cost > 1.5 * cost_when_built) {
///         rebuild_bvh(bvh, positions, triangles, {.quality = Quality::fast});
///         cost_when_built = surface_cost(bvh);
///     }
///
/// O(n). Allocates nothing when done before with the same options, but for 80 bytes per
/// 4,096 triangles with oriented boxes.
double refit_bvh(Bvh& bvh, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const BvhOptions& options = {});

}  // namespace cdprep::build
