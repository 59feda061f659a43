// SPDX-License-Identifier: MIT
#include "cdprep/build_octree.h"

#include <algorithm>

#include "cell_boxes.h"
#include "octree_grid.h"
#include "octree_levels.h"
#include "octree_tables.h"

namespace cdprep::build {

Octree build_octree(std::span<const format::Double3> positions,
                    std::span<const format::Triangle> triangles, const OctreeOptions& options) {
    Octree octree;
    octree.grid = octree_grid_around(positions, options.parallel_for);
    octree.grid.level = std::min(options.level, format::kOctreeBits);
    octree.grid.threshold = std::max(options.threshold, 1U);
    if (!triangles.empty()) divide_octree(octree, positions, triangles, options.parallel_for);
    if (options.hashed) make_octree_tables(octree);
    if (options.boxes_in) {
        bound_cells(octree, positions, triangles, *options.boxes_in, options.parallel_for);
    }
    return octree;
}

}  // namespace cdprep::build
