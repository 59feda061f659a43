// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/pieces.h"
#include "decompose/surface/piece_arrays.h"

namespace cdprep::convex {

/// The hierarchy over pieces as a baked file stores it (format/pieces.h).
struct PieceTree {
    std::vector<format::BvhNode> nodes;
    std::vector<format::SweptNode> swept;
    std::vector<format::PieceLeaf> leaves;
    std::vector<format::PieceNodeHull> hulls;
};

/// Builds the hierarchy over the pieces of a mesh. Boxes are in the given frame of the mesh. The
/// surface-area heuristic cuts the leaves. Hulls are exact where those have few corners, else
/// enclosing ones. The same for any parallel_for.
///
/// Returns nothing if there would be more than format::kMaxPieceLeaves leaves.
[[nodiscard]] PieceTree make_piece_tree(const mesh::Mesh& mesh, const PieceArrays& pieces,
                                        const build::Frame& frame, ParallelFor parallel_for);

}  // namespace cdprep::convex
