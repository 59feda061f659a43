// SPDX-License-Identifier: MIT
#include "support/every_structure.h"

#include <algorithm>

namespace cdprep::test {

AlignedBytes with_every_structure(const AlignedBytes& file, const Division& division) {
    const auto [level, threshold, boxes] = division;
    const auto boxes_in = boxes ? std::optional(build::Frame{}) : std::nullopt;
    const AlignedBytes octree =
        with_octree(file, {.level = level, .threshold = threshold, .boxes_in = boxes_in});
    const AlignedBytes adaptive = with_adaptive_octree(
        octree, {.level = level, .threshold = threshold, .boxes_in = boxes_in});
    return with_tetra_tree(
        adaptive, {.level = std::min(level, format::kMaxTetraLevel),
                   .threshold = threshold,
                   .bounding = boxes ? format::TetraBounding::boxes : format::TetraBounding::caps});
}

OpenModel open_with_every_structure(const TestMesh& mesh, const Division& division) {
    return open_tiny(with_every_structure(
        bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}), division));
}

}  // namespace cdprep::test
