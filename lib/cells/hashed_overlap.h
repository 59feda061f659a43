// SPDX-License-Identifier: MIT
#pragma once

#include "cells/contacts_through.h"

namespace cdprep {

/// Does the same as visit_contacts_through_trees(), through hashed octrees.
///
/// Structure::hashed_octree: tests the boxes of one model's hierarchy, from the root down, against
/// cells of the other's octree. The cells are as large as the boxes: at most eight, found by their
/// keys. Boxes without such cells are discarded. The lowest nodes, with 64 triangles, are tested
/// against the leaf cells below. Then their triangles are tested against those that these cells
/// list. The model whose octree is used is chosen for speed; the choice does not change the result.
///
/// Both models must serve Ask::hashed_octree.
bool visit_contacts_through_keys(const QuestionThrough& question, TreePairVisitor visit) noexcept;

}  // namespace cdprep
