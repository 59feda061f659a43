// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "cdprep/overlapping_triangles.h"

namespace cdprep {

struct WithinOptions {
    Degenerate degenerate = Degenerate::keep;
};

/// Finds every pair of triangles of `a` and `b` that are at most `tolerance` apart,
/// model units: the tolerance belongs to it, and pairs that touch are 0 apart.
///
/// Returns how many there are and stores the first of them, in the order of (a, b), in
/// `pairs`, as overlapping_triangles() does: a span that is too short is filled with
/// the smallest pairs, an empty one counts. A tolerance of 0 gives the pairs of
/// overlapping_triangles() with Overlap::closed, an infinite one all pairs; a negative
/// one or NaN gives none, and an empty model has none.
///
/// Exact for the vertices as `placement` moves them (Pose, level E1), the same on every
/// machine: two that are apart by the tolerance to the last bit are within it, and by
/// one step less they are not. Degenerate triangles are as far away as the segment or
/// point that they are, unless they are skipped.
///
/// Needs Ask::within of both models. Costs O(log n + pairs) for compact
/// surfaces and tolerances that are small against them, O(n m) at worst. Never
/// allocates. If only "is any?" matters, is_within() stops at the first; if "how far?",
/// distance() tells.
[[nodiscard]] std::size_t triangles_within(const Model& a, const Model& b,
                                           const Placement& placement, double tolerance,
                                           Workspace& workspace, std::span<TrianglePair> pairs,
                                           const WithinOptions& options = {}) noexcept;

/// Calls `visit` with every pair that triangles_within() finds, each once, as it is
/// found: no room for pairs is needed, and nothing is sorted. The order is the same for
/// equal input on equal processors and means nothing. Returns false when `visit` ended
/// the search.
///
///     std::vector<bool> is_near(a.triangle_count());
///     const auto visit = [&](const cdprep::TrianglePair& pair) {
///         is_near[pair.a] = true;
///         return true;
///     };
///     cdprep::visit_triangles_within(a, b, placement, 0.25, workspace, visit);
bool visit_triangles_within(const Model& a, const Model& b, const Placement& placement,
                            double tolerance, Workspace& workspace, PairVisitor visit,
                            const WithinOptions& options = {}) noexcept;

}  // namespace cdprep
