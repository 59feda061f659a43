// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "cdprep/format/verdict.h"
#include "mesh/half_edges.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// What is true of a mesh as it is stored: vertices are the same where their numbers are,
/// wherever they lie. (find_defects joins equal positions first.) A split at a
/// non-manifold edge shows only so.
struct StoredVerdict {
    format::Verdict verdict{};  ///< of the whole mesh; crossings are not examined
    std::uint64_t repeated_corners = 0;
    std::uint64_t duplicate_triangles = 0;  ///< of either winding
    std::uint64_t boundary_edges = 0;
    std::uint64_t non_manifold_edges = 0;
    std::uint64_t non_manifold_vertices = 0;
    std::uint64_t inconsistent_edges = 0;
    std::uint64_t components = 0;           ///< of triangles that share a vertex
    std::uint64_t closed_components = 0;    ///< without a boundary edge
    std::uint64_t inverted_components = 0;  ///< balanced, of negative volume
};

/// `verdict_two_manifold` also asks that no two triangles have the same corners. O(n log n).
[[nodiscard]] StoredVerdict find_stored_verdict(std::span<const Double3> positions,
                                                std::span<const Triangle> triangles);

/// How many uses of edges have no opposite one, however many triangles share the edge.
[[nodiscard]] std::uint64_t count_unpaired_uses(std::span<const Double3> positions,
                                                std::span<const Triangle> triangles);

/// One component of triangles that share vertices.
struct StoredComponent {
    std::vector<std::uint32_t> triangles;
    bool closed = true;       ///< no edge has one use
    bool balanced = true;     ///< the uses of every edge cancel
    double volume = 0;        ///< signed; 0 unless balanced
    double volume_error = 0;  ///< the exact volume is that near
};

/// In the order of their lowest triangle.
[[nodiscard]] std::vector<StoredComponent> find_stored_components(
    std::span<const Double3> positions, std::span<const Triangle> triangles);

/// Returns whether `after` lacks what `before` had: inside defined, manifold, oriented,
/// closed. Of the last three a later one may be given up for an earlier one: an edge of
/// three triangles is closed, by the word, and bounds nothing.
[[nodiscard]] bool is_worse(const StoredVerdict& after, const StoredVerdict& before) noexcept;

}  // namespace cdprep::mesh
