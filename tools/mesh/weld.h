// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "mesh/mesh.h"

namespace cdprep::mesh {

struct WeldOptions {
    /// Vertices at most this far apart become one. Model units. 0 merges only
    /// vertices whose coordinates are equal (-0.0 equals 0.0). Finite.
    double distance = 0.0;
};

struct WeldReport {
    std::size_t merged_vertices = 0;      ///< used vertices that became another one
    std::size_t unused_vertices = 0;      ///< left out: no triangle uses them
    std::size_t collapsed_triangles = 0;  ///< triangles that now repeat a corner: kept
};

struct Welded {
    Mesh mesh;
    WeldReport report;
};

/// Merges coincident vertices so that neighbouring triangles share them.
///
/// Every surviving vertex keeps the position of the lowest-numbered vertex it
/// stands for: welding never invents coordinates, and welding twice changes
/// nothing. Vertices stand in the order of their lowest source number; triangle
/// order is kept. With a distance, chains merge: the groups are those of the
/// transitive closure. Positions must be finite. O(n), with a distance O(n) for
/// meshes whose vertices are about that far apart.
[[nodiscard]] Welded weld(const TriangleSoup& soup, const WeldOptions& options = {});

}  // namespace cdprep::mesh
