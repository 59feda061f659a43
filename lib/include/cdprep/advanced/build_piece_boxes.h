// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/pieces.h"

namespace cdprep::build {

/// A surface cut into pieces, as format/pieces.h says.
struct PiecesOf {
    std::span<const format::Double3> positions;
    std::span<const format::Triangle> triangles;
    std::span<const format::Piece> pieces;
    std::span<const std::uint32_t> piece_triangles;  ///< numbers in `triangles`
};

/// Sections piece_nodes, piece_swept and piece_leaves.
struct PieceBoxes {
    std::vector<format::BvhNode> nodes;
    std::vector<format::SweptNode> swept;
    std::vector<format::PieceLeaf> leaves;
};

/// Builds the hierarchy of boxes over pieces, in the frame of the model's own hierarchy. Each
/// piece is cut into as few leaves as hold it, of about one length; leaves stand as
/// build_bvh() would put triangles with their boxes. The same for any parallel_for. Nothing when
/// there would be more than format::kMaxPieceLeaves leaves.
[[nodiscard]] PieceBoxes build_piece_boxes(const PiecesOf& surface, const Frame& frame,
                                           ParallelFor parallel_for);

}  // namespace cdprep::build
