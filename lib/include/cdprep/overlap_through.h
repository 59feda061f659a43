// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "cdprep/overlapping_triangles.h"
#include "cdprep/piece_cache.h"
#include "cdprep/structure.h"

namespace cdprep {

/// Finds what overlapping_triangles() finds, through another structure of both files,
/// with the same sets, the same order and the same exactness. Never allocates; takes some
/// 20 KiB of stack. Needs Ask::overlap and ask_of() the structure of both models.
/// Costs most where triangles are larger than cells and thousands of pairs overlap: then
/// answers cannot all be remembered, and each is traced to the cells that own it.
/// Structure::hashed_octree_literal finds a part of them: that is the talk's algorithm.
[[nodiscard]] std::size_t overlapping_triangles_through(
    const StructureOptions& through, const Model& a, const Model& b, const Placement& placement,
    Workspace& workspace, std::span<TrianglePair> pairs,
    const OverlapOptions& options = {}) noexcept;

/// Returns whether any two triangles overlap; stops at the first pair found. `cache` may be
/// null; Structure::bvh and Structure::pieces start from it, the others leave it alone. Needs
/// Ask::collide and ask_of(through.structure) of both models.
[[nodiscard]] bool any_overlap_through(const StructureOptions& through, const Model& a,
                                       const Model& b, const Placement& placement,
                                       Workspace& workspace, const OverlapOptions& options = {},
                                       PieceCache* cache = nullptr) noexcept;

}  // namespace cdprep
