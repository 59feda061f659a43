// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "decompose/surface/patch_set.h"
#include "decompose/surface/surface_pieces.h"

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

}  // namespace cdprep::convex
