// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/model.h"
#include "cdprep/pair_cache.h"
#include "cdprep/placement.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// One triangle of each model, in the numbering of the imported files.
struct TrianglePair {
    std::uint32_t a;
    std::uint32_t b;
    friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// What counts as an overlap of two triangles.
enum class Overlap : std::uint8_t {
    closed,  ///< any common point: touching counts
    proper,  ///< the triangles cross, or share area in one plane
};

/// What becomes of triangles with collinear corners.
enum class Degenerate : std::uint8_t {
    keep,  ///< they answer as the segment or point that they are
    skip,  ///< they never answer
};

struct OverlapOptions {
    Overlap overlap = Overlap::closed;
    Degenerate degenerate = Degenerate::keep;
};

/// Finds every pair of triangles of `a` and `b` that have a point in common.
///
/// Returns how many there are and stores the first of them, in the order of
/// (a, b), in `pairs`. When `pairs` is too short, it is filled with the smallest
/// pairs and the true number is still returned; so an empty span counts.
/// The order costs a sort of the stored pairs.
///
/// Exact: the answer is that of exact arithmetic on the vertices as `placement`
/// moves them (Pose, level E1), the same on every machine and in every floating-point
/// environment of the caller. An empty model overlaps nothing.
///
/// Needs Ask::overlap of both models; oriented_nodes or swept_nodes make it faster.
///
/// Costs O(log n + pairs) for compact surfaces, O(n m) at worst. Never
/// allocates. If only "do they touch?" matters, collide() stops at the first.
/// `cache` may be null; with it, poses in which nothing touches cost what collide() does.
[[nodiscard]] std::size_t overlapping_triangles(const Model& a, const Model& b,
                                                const Placement& placement, Workspace& workspace,
                                                std::span<TrianglePair> pairs,
                                                const OverlapOptions& options = {},
                                                PairCache* cache = nullptr) noexcept;

using PairVisitor = Visitor<TrianglePair>;

/// Calls `visit` with every pair that overlapping_triangles() finds, each once, as
/// it is found: no room for pairs is needed, and nothing is sorted. The order is the
/// same for equal input on equal processors and means nothing. Returns false when
/// `visit` ended the search.
///
///     std::size_t count = 0;
///     const auto visit = [&](const cdprep::TrianglePair&) { return ++count < 1000; };
///     cdprep::visit_overlapping_triangles(a, b, placement, workspace, visit);
bool visit_overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                 Workspace& workspace, PairVisitor visit,
                                 const OverlapOptions& options = {},
                                 PairCache* cache = nullptr) noexcept;

/// Marks the triangles of either model that overlap any of the other: bit i % 64 of
/// element i / 64 for source triangle i. Clears `bits_a` and `bits_b` first; each
/// must have an element for every 64 triangles of its model, or nothing is marked
/// for it. Returns the number of pairs. Less than overlapping_triangles() where
/// many pairs share few triangles: nothing is stored or sorted.
std::size_t mark_overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                       Workspace& workspace, std::span<std::uint64_t> bits_a,
                                       std::span<std::uint64_t> bits_b,
                                       const OverlapOptions& options = {},
                                       PairCache* cache = nullptr) noexcept;

}  // namespace cdprep
