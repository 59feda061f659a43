// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "support/tiny_baker.h"

#include "cdprep/format/pieces.h"
#include "cdprep/model.h"

namespace cdprep::test {

/// Returns the sections of a hierarchy over these pieces of a model. The hull of each node is a
/// box around the model.
[[nodiscard]] std::vector<TinySection> piece_tree_sections(
    const Model& model, std::span<const format::Piece> pieces,
    std::span<const std::uint32_t> triangles);

/// Returns the file with pieces and a hierarchy over them. The pieces are not convex. Each has 1
/// to 20 triangles that are near each other in the tree order. Many pieces therefore have several
/// leaves, and their triangles are mixed with those of other pieces. The hull of each node is a
/// box around the model. No query result depends on the pieces.
[[nodiscard]] AlignedBytes with_piece_tree(const AlignedBytes& file);

}  // namespace cdprep::test
