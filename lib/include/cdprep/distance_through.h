// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/distance.h"
#include "cdprep/piece_cache.h"
#include "cdprep/structure.h"
#include "cdprep/triangles_within.h"

namespace cdprep {

/// Answers as distance(), bit for bit where the models do not touch, and where they do perhaps by
/// another pair of triangles that touch, through another structure of both files:
/// Structure::pieces. Through every other structure distance() itself answers. Needs what
/// distance() needs, and ask_of() the structure of both models. Never allocates. `cache` may be
/// null.
[[nodiscard]] std::optional<Distance> distance_through(const StructureOptions& through,
                                                       const Model& a, const Model& b,
                                                       const Placement& placement,
                                                       Workspace& workspace,
                                                       const DistanceOptions& options = {},
                                                       PieceCache* cache = nullptr) noexcept;

/// Answers as is_within(). Needs Ask::within and ask_of() the structure of both models.
[[nodiscard]] bool is_within_through(const StructureOptions& through, const Model& a,
                                     const Model& b, const Placement& placement, double tolerance,
                                     Workspace& workspace, PieceCache* cache = nullptr) noexcept;

/// Answers as triangles_within(), the same pairs in the same order. Needs Ask::within and
/// ask_of() the structure of both models.
[[nodiscard]] std::size_t triangles_within_through(const StructureOptions& through, const Model& a,
                                                   const Model& b, const Placement& placement,
                                                   double tolerance, Workspace& workspace,
                                                   std::span<TrianglePair> pairs,
                                                   const WithinOptions& options = {}) noexcept;

}  // namespace cdprep
