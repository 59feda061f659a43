// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/pieces.h"
#include "decompose/surface/piece_arrays.h"

namespace cdprep::convex {

/// The hierarchy over pieces as a baked file holds it (format/pieces.h).
struct PieceTree {
    std::vector<format::BvhNode> nodes;
    std::vector<format::SweptNode> swept;
    std::vector<format::PieceLeaf> leaves;
    std::vector<format::PieceNodeHull> hulls;
};

/// Builds the hierarchy over the pieces of a mesh, in whose frame the boxes are. Leaves stand
/// as the surface-area heuristic cuts them; hulls are the exact ones where those have few
/// corners, else enclosing ones. The same for any parallel_for.
///
/// Nothing when there would be more than format::kMaxPieceLeaves leaves.
[[nodiscard]] PieceTree make_piece_tree(const mesh::Mesh& mesh, const PieceArrays& pieces,
                                        const build::Frame& frame, ParallelFor parallel_for);

}  // namespace cdprep::convex
