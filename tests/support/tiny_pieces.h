// SPDX-License-Identifier: MIT
#pragma once

#include "support/tiny_baker.h"

namespace cdprep::test {

/// The same file with pieces and a hierarchy over them. The pieces are no convex ones: some
/// triangles that lie near each other in the tree order, 1 to 20 each, so that many a piece has
/// several leaves, and its triangles stand among those of others. Hulls around nodes are boxes
/// around the model. No answer depends on what pieces are.
[[nodiscard]] AlignedBytes with_piece_tree(const AlignedBytes& file);

}  // namespace cdprep::test
