// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/api.h"
#include "cdprep/format/pieces.h"

namespace cdprep::build {

/// A surface cut into convex pieces. Each piece lies on its own convex hull, up to
/// Piece::outer_error (format/pieces.h).
struct PiecesOf {
    std::span<const format::Double3> positions;
    std::span<const format::Triangle> triangles;
    std::span<const format::Piece> pieces;
    std::span<const std::uint32_t> piece_triangles;  ///< numbers in `triangles`
};

/// The contents of the sections piece_nodes, piece_swept and piece_leaves.
struct PieceBoxes {
    std::vector<format::BvhNode> nodes;
    std::vector<format::SweptNode> swept;
    std::vector<format::PieceLeaf> leaves;
};

/// Builds the BVH over pieces, in the frame of the model's own BVH. Each piece is cut into the
/// fewest leaves that hold it, with about equal numbers of triangles. The leaves have the order
/// that build_bvh() would give to triangles with the same boxes. Returns empty arrays if there
/// would be more than format::kMaxPieceLeaves leaves. The result is the same for any parallel_for.
[[nodiscard]] CDPREP_API PieceBoxes build_piece_boxes(const PiecesOf& surface, const Frame& frame,
                                                      ParallelFor parallel_for);

}  // namespace cdprep::build
