// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "decompose/surface/patch_set.h"
#include "mesh/stop.h"

namespace cdprep::convex {

/// Joins neighbouring patches over crossable edges, bottom-up, until no more can be: of all
/// edges always the one at which the fewest others are left around its two patches, the
/// sharpest of equal ones; with a tolerance the smallest patches first, the flattest of
/// equal ones. First within each 4096 triangles of the tree order, then within
/// eight such runs and so on: the parts of a step run side by side, and the result is the
/// same for any parallel_for. Stops early where a part has done `work` tests a triangle.
void merge_patches(const PatchRules& rules, PatchSet& patches, std::uint64_t work,
                   const mesh::StopCheck& stop, ParallelFor parallel_for);

}  // namespace cdprep::convex
