// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decompose/surface/patch_set.h"

namespace cdprep::convex {

/// Makes one patch of every region, a set of triangles that convex and flat edges connect,
/// whose triangles all lie on its hull and whose hull stays inside. Exact. The same for any
/// parallel_for. n triangles take O(n log n), where merging takes O(n) for each of them;
/// small regions without a flat edge are left alone.
void close_convex_regions(const PatchRules& rules, PatchSet& patches, ParallelFor parallel_for);

/// Makes one patch of every set of triangles in one plane that flat edges connect and that
/// fill a convex polygon, unless they are one already: merged step by step, parts of them
/// would be refused for not being convex. Exact. The same for any parallel_for.
void fill_polygons(const PatchRules& rules, PatchSet& patches, ParallelFor parallel_for);

}  // namespace cdprep::convex
