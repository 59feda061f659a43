// SPDX-License-Identifier: MIT
#pragma once

#include "cells/contacts_through.h"

namespace cdprep {

/// The talk's algorithm to the letter: for each triangle of B that A's oriented box may hold
/// (PotentialSet), what the leaf cells of A's octree list in which its corners lie. Misses
/// triangles that cross others between their corners.
///
/// Where the cells are, a corner is where the ideal motion rounded once puts it: exactly the
/// point that the question is about when A stays. A corner outside the cube is in no cell.
bool visit_by_corners(const QuestionThrough& question, ContactVisitor visit) noexcept;

}  // namespace cdprep
