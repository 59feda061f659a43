// SPDX-License-Identifier: MIT
#include "cdprep/cells/build_octree.h"

#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "cells/build/cell_boxes.h"
#include "cells/build/octree_grid.h"
#include "cells/build/octree_steps.h"
#include "core/guarded_for.h"

namespace cdprep::build {

Octree build_octree(std::span<const format::Double3> positions,
                    std::span<const format::Triangle> triangles, const OctreeOptions& options) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, options.parallel_for);
    Octree octree;
    octree.grid = octree_grid_around(positions, guarded);
    octree.grid.level = std::min(options.level, format::kOctreeBits);
    octree.grid.threshold = std::max(options.threshold, 1U);
    if (!triangles.empty()) divide_octree(octree, positions, triangles, guarded);
    if (options.hashed) make_octree_tables(octree);
    if (options.boxes_in) {
        bound_cells(octree, positions, triangles, *options.boxes_in, guarded);
    }
    return octree;
}

}  // namespace cdprep::build
