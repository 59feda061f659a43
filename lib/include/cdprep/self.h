// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// The options of a query about one model against itself.
struct SelfOptions {
    Overlap overlap = Overlap::closed;
    Degenerate degenerate = Degenerate::keep;
};

/// Finds every pair of triangles of one model that have a common point and share no vertex. Both
/// numbers of a pair name triangles of the model, a < b.
///
/// Returns the number of pairs. Stores the first of them in `room`, in the order of (a, b), by the
/// rules of overlaps(). With an empty span it only counts.
///
/// Triangles share a vertex if they use the same vertex number of the model. A bake merges vertices
/// with equal positions into one. Two vertices of a LiveModel may move to one position later. They
/// remain two vertices, so triangles that touch there are a pair. Triangles that share a vertex are
/// in no pair, even if they overlap, as in a flat fold. In a torn LiveModel, only the present
/// triangles are in pairs.
///
/// Exact: the answer is that of exact arithmetic on the model's own positions. It is the same on
/// every machine and in every floating-point environment of the caller. An empty model has no
/// pairs.
///
/// Reads both options. Needs Ask::overlap and Ask::corners. Ask::corners covers the numbers of
/// vertices, which Ask::overlap does not require. Takes O(n + pairs) time for typical meshes,
/// O(n^2) in the worst case. Never allocates.
[[nodiscard]] CDPREP_API std::size_t self_overlaps(const Model& model, Workspace& workspace,
                                                   std::span<TrianglePair> room,
                                                   const SelfOptions& options = {}) noexcept;

/// Calls `visit` once for each pair that self_overlaps() finds, as the search finds it. Stores and
/// sorts nothing. The order is the same for equal input on equal processors, otherwise unspecified.
/// Returns false if `visit` ended the search. Reads both options. Needs Ask::overlap and
/// Ask::corners. Never allocates.
CDPREP_API bool visit_self_overlaps(const Model& model, Workspace& workspace, PairVisitor visit,
                                    const SelfOptions& options = {}) noexcept;

}  // namespace cdprep
