// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "decompose/surface/patch_set.h"
#include "decompose/surface/surface_pieces.h"
#include "mesh/stop.h"

namespace cdprep::convex {

/// Grows one patch after the other from a seed, in the given order. A patch grows triangle by
/// triangle over crossable edges, until it refuses all its neighbours. A refused triangle is tried
/// again by other patches only. Seeds are the lowest free triangles by `place` (the mesh's own
/// numbers). With `cresting`, they are the triangles farthest from a triangle at a reflex edge or
/// barrier, counted in triangles, lowest first. Runs serially, because each patch depends on the
/// earlier ones. `work` as in merge_patches().
void grow_patches(const PatchRules& rules, PatchSet& patches, PieceOrder order,
                  std::span<const std::uint32_t> place, std::uint64_t work,
                  const mesh::StopCheck& stop);

/// Joins neighbouring patches over crossable edges, bottom-up, until no more can be joined. The
/// next edge is the one that leaves the fewest other edges around its two patches; the sharpest
/// wins a tie. With a tolerance, the smallest patches come first, and the flattest edge wins a tie.
/// The first step stays within each 4096 triangles of the tree order, the next one within eight
/// such runs, and so on. The parts of a step run in parallel. The result is the same for any
/// parallel_for. A part ends early after `work` tests per triangle.
void merge_patches(const PatchRules& rules, PatchSet& patches, std::uint64_t work,
                   const mesh::StopCheck& stop, ParallelFor parallel_for);

/// Makes one patch of every convex region. A region is a set of triangles that convex and flat
/// edges connect. It is convex if its triangles all lie on its hull and its hull stays inside. With
/// a tolerance the hull may leave the solid, and the patch says so. Exact. The same for any
/// parallel_for. n triangles take O(n log n), where merging takes O(n) for each of them. Small
/// regions without a flat edge are skipped.
void close_convex_regions(const PatchRules& rules, PatchSet& patches, ParallelFor parallel_for);

/// Makes one patch of every set of coplanar triangles that fill a convex polygon, unless it is one
/// already. Flat edges must connect the set. Step-by-step merging would refuse parts of it that are
/// not convex. Exact. The same for any parallel_for.
void fill_polygons(const PatchRules& rules, PatchSet& patches, ParallelFor parallel_for);

}  // namespace cdprep::convex
