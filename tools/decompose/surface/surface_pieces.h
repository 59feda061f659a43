// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "decompose/surface/surface_edges.h"
#include "mesh/mesh.h"
#include "mesh/stop.h"

namespace cdprep::convex {

/// The algorithm that makes the pieces.
enum class PieceOrder : std::uint8_t {
    greedy,         ///< neighbouring patches merge, bottom-up; the fewest pieces, in parallel
    depth_first,    ///< a patch grows from the lowest free triangle, last neighbour first
    breadth_first,  ///< the same, but first neighbour first
    cresting        ///< breadth first, from triangles far from reflex edges and barriers
};

struct SurfacePieceOptions {
    PieceOrder order = PieceOrder::greedy;
    /// Model units, 0 or more. In a piece, each vertex is proved to be at most this far above each
    /// plane of its triangles. 0: exact.
    double tolerance = 0;
    ParallelFor parallel_for = serial_for;
    mesh::StopCheck stop = {};  ///< if it stops, the result is of no use
};

/// The properties of a piece besides its triangles.
struct SurfacePiece {
    /// True if the hull of the vertices has no point outside the solid that the component bounds.
    /// The component is then balanced. Neither its triangles nor those of balanced components wound
    /// inwards have a point strictly inside the hull. Exact. A flat piece is contained if it fills
    /// its hull.
    bool contained = false;
    /// Proved: no vertex is more than this above the plane of a triangle. The triangles therefore
    /// lie at most this deep below the hull. 0 if and only if all lie on the hull. Model units.
    double outer_error = 0;
};

/// A partition of a surface into pieces. Each piece by itself is part of the boundary of a convex
/// body, exactly or within a tolerance.
struct SurfacePieces {
    std::vector<std::uint32_t> triangles;         ///< each once: by piece, ascending in each
    std::vector<std::uint32_t> first;             ///< where each piece starts there; then the total
    std::vector<SurfacePiece> pieces;             ///< in the order of their lowest triangle
    std::array<std::size_t, kEdgeKinds> edges{};  ///< by EdgeKind: number of edges in the mesh

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t piece) const {
        return std::span(triangles).subspan(first[piece], first[piece + 1] - first[piece]);
    }
};

/// Cuts the surface of a mesh into convex pieces: patches whose triangles all lie on the boundary
/// of the hull of their vertices. Accepts every mesh. Pieces never cross borders, non-manifold
/// edges or inconsistent edges, and without a tolerance no reflex edges. A triangle without area is
/// a piece by itself. Pieces of components that are not balanced are never marked as contained.
///
/// All signs are exact: without a tolerance every triangle lies on its hull exactly, and
/// `contained` is exact. A mesh without reflex edges whose triangles lie on its hull becomes one
/// piece per component. Positions must be finite and at most format::kMaxCoordinate, and no two may
/// be equal (weld() ensures this). The pieces are the same for any parallel_for. The work per
/// triangle is limited. Only large, nearly convex surfaces come near the limit; they then have more
/// pieces than necessary. Measured by tests/bench/surface_pieces_bench.
[[nodiscard]] SurfacePieces find_surface_pieces(const mesh::Mesh& mesh,
                                                const SurfacePieceOptions& options = {});

}  // namespace cdprep::convex
