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

/// How pieces come about.
enum class PieceOrder : std::uint8_t {
    greedy,         ///< neighbouring patches merge, bottom-up; the fewest pieces, in parallel
    depth_first,    ///< a patch grows from the lowest free triangle, last neighbour first
    breadth_first,  ///< and first neighbour first
    cresting        ///< breadth first, from triangles far from reflex edges and barriers
};

struct SurfacePieceOptions {
    PieceOrder order = PieceOrder::greedy;
    /// Model units, 0 or more. A patch is a piece while no vertex of it is known to be more
    /// than this above a plane of its triangles. 0: exact.
    double tolerance = 0;
    /// Tests of a point against a plane for each triangle, some nanoseconds each, so that
    /// nothing hangs: only large surfaces that are all but convex come near, and then have
    /// more pieces than they need. The same for any parallel_for.
    std::uint64_t most_work = 5000;
    ParallelFor parallel_for = serial_for;
    mesh::StopCheck stop = {};  ///< then the result is of no use
};

/// What is said of a piece besides its triangles.
struct SurfacePiece {
    /// The hull of its vertices has no point outside the solid that its component bounds:
    /// the component is closed, and neither a triangle of it nor one of a closed component
    /// wound inwards has a point strictly inside the hull. Exact. A flat piece is contained
    /// when it fills its hull.
    bool contained = false;
    /// Proved: no vertex is more than this above the plane of a triangle, so that the
    /// triangles lie at most this deep below the hull. 0 exactly when all lie on the hull.
    /// Model units.
    double outer_error = 0;
};

/// A partition of a surface into pieces that are, each by itself, part of the boundary of
/// a convex body, or nearly so.
struct SurfacePieces {
    std::vector<std::uint32_t> triangles;  ///< each once: by piece, ascending in each
    std::vector<std::uint32_t> first;      ///< of each piece in `triangles`; then their number
    std::vector<SurfacePiece> pieces;      ///< in the order of their lowest triangle
    std::array<std::size_t, kEdgeKinds> edges{};  ///< by EdgeKind: how many of each the mesh has

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t piece) const {
        return std::span(triangles).subspan(first[piece], first[piece + 1] - first[piece]);
    }
};

/// Cuts the surface of a mesh into convex pieces: patches whose triangles all lie on the
/// boundary of the hull of their vertices. Never refuses: borders and edges that are not
/// manifold or not consistent are never crossed, nor are, without a tolerance, reflex ones,
/// and a triangle without area is a piece by itself. Pieces of components that are not
/// closed say that they are not contained.
///
/// All signs are exact: without a tolerance every triangle lies on its hull exactly, and
/// what is said to be contained is. A mesh without reflex edges whose triangles lie on its
/// hull is one piece for each component. Positions must be finite and at most
/// format::kMaxCoordinate, no two may be equal (weld() sees to it). The same pieces for any
/// parallel_for. tests/bench/surface_pieces_bench measures.
[[nodiscard]] SurfacePieces find_surface_pieces(const mesh::Mesh& mesh,
                                                const SurfacePieceOptions& options = {});

}  // namespace cdprep::convex
