// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "support/tiny_baker.h"

#include "cdprep/format/pieces.h"
#include "cdprep/model.h"

namespace cdprep::test {

/// A hierarchy over these pieces of a model. Hulls around nodes are boxes around the model.
[[nodiscard]] std::vector<TinySection> piece_tree_sections(
    const Model& model, std::span<const format::Piece> pieces,
    std::span<const std::uint32_t> triangles);

/// The same file with pieces and a hierarchy over them. The pieces are no convex ones: some
/// triangles that lie near each other in the tree order, 1 to 20 each, so that many a piece has
/// several leaves, and its triangles stand among those of others. Hulls around nodes are boxes
/// around the model. No answer depends on what pieces are.
[[nodiscard]] AlignedBytes with_piece_tree(const AlignedBytes& file);

}  // namespace cdprep::test
