// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "decompose/surface/patch_set.h"
#include "decompose/surface/surface_pieces.h"
#include "mesh/stop.h"

namespace cdprep::convex {

/// Grows one patch after the other from a seed, triangle by triangle over crossable edges,
/// until none of its neighbours may join it, in the order asked for. A triangle that was
/// refused is asked again by other patches only. Seeds are the lowest free triangles by
/// `place` (the mesh's own numbers), cresting: those farthest from a triangle at a reflex
/// edge or barrier, counted in triangles, lowest first. One after the other: each depends on
/// those before. `work` as in merge_patches().
void grow_patches(const PatchRules& rules, PatchSet& patches, PieceOrder order,
                  std::span<const std::uint32_t> place, std::uint64_t work,
                  const mesh::StopCheck& stop);

/// Joins neighbouring patches over crossable edges, bottom-up, until no more can be: of all
/// edges always the one at which the fewest others are left around its two patches, the
/// sharpest of equal ones; with a tolerance the smallest patches first, the flattest of
/// equal ones. First within each 4096 triangles of the tree order, then within
/// eight such runs and so on: the parts of a step run side by side, and the result is the
/// same for any parallel_for. Stops early where a part has done `work` tests a triangle.
void merge_patches(const PatchRules& rules, PatchSet& patches, std::uint64_t work,
                   const mesh::StopCheck& stop, ParallelFor parallel_for);

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
