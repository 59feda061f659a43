// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "mesh/mesh.h"

namespace cdprep::mesh {

struct WeldOptions {
    /// Vertices at most this far apart are merged; model units. 0 merges only vertices with
    /// equal coordinates (-0.0 equals 0.0). Finite.
    double distance = 0.0;
};

struct WeldReport {
    std::size_t merged_vertices = 0;      ///< used vertices that were merged into others
    std::size_t unused_vertices = 0;      ///< dropped: no triangle uses them
    std::size_t collapsed_triangles = 0;  ///< triangles that now repeat a corner; kept
};

struct Welded {
    Mesh mesh;
    WeldReport report;
};

/// Merges coincident vertices, so that neighbouring triangles share them.
///
/// Every remaining vertex keeps the position of the lowest-numbered vertex it represents. So
/// welding never invents coordinates, and welding twice changes nothing. Vertices are in the
/// order of their lowest source number; triangles keep their order. With a distance, chains
/// merge: the groups are those of the transitive closure. Positions must be finite. O(n); with a
/// distance, O(n) for meshes whose vertices are about that far apart.
[[nodiscard]] Welded weld(const TriangleSoup& soup, const WeldOptions& options = {});

}  // namespace cdprep::mesh
