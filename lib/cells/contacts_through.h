// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/cells/overlap_through.h"
#include "cdprep/visitor.h"
#include "walk/find_contact.h"
#include "walk/walk_pairs.h"

namespace cdprep {

/// A query about two models through a structure of both.
struct QuestionThrough {
    const StructureOptions& through;
    const Model& a;
    const Model& b;
    const Placement& placement;
    Workspace& workspace;
    const PairOptions& options;
    Search search;  ///< first: the caller stops at the first pair
};

/// Calls `visit` once for every pair of triangles in contact, with numbers in tree order, until it
/// returns false. Returns false when it did. Neither model is empty.
using TreePairVisitor = Visitor<TreePair>;

bool visit_contacts_through_trees(const QuestionThrough& question, TreePairVisitor visit) noexcept;

}  // namespace cdprep
