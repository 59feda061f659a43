// SPDX-License-Identifier: MIT
#pragma once

#include "cells/contacts_through.h"

namespace cdprep {

/// What visit_contacts_through_trees() does, through hashed octrees.
///
/// Structure::hashed_octree: boxes of one model's hierarchy, from the root down, are held
/// against the cells of the other's octree that are as large as they are: at most eight,
/// found by their keys. Boxes without such cells are left out; the lowest nodes, 64
/// triangles, are held against the leaf cells below, and what those list is tested. Which
/// model's octree it is, is chosen for speed and does not show.
///
/// Both models must serve Ask::hashed_octree.
bool visit_contacts_through_keys(const QuestionThrough& question, ContactVisitor visit) noexcept;

}  // namespace cdprep
