// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "cdprep/format/verdict.h"
#include "mesh/half_edges.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// The facts about a mesh as stored: vertices are equal if their numbers are, wherever they lie.
/// (find_defects() joins equal positions first.) Only this view shows a split at a non-manifold
/// edge.
struct StoredVerdict {
    format::Verdict verdict{};  ///< of the whole mesh; does not examine crossings
    std::uint64_t repeated_corners = 0;
    std::uint64_t duplicate_triangles = 0;  ///< in either winding
    std::uint64_t boundary_edges = 0;
    std::uint64_t non_manifold_edges = 0;
    std::uint64_t non_manifold_vertices = 0;
    std::uint64_t inconsistent_edges = 0;
    std::uint64_t components = 0;           ///< sets of triangles connected by shared vertices
    std::uint64_t closed_components = 0;    ///< without a boundary edge
    std::uint64_t inverted_components = 0;  ///< balanced, with negative volume
};

/// Returns the facts. `verdict_two_manifold` also requires that no two triangles have the same
/// corners. O(n log n).
[[nodiscard]] StoredVerdict find_stored_verdict(std::span<const Double3> positions,
                                                std::span<const Triangle> triangles);

/// Returns the number of edge uses without an opposite one, over all edges of any number of
/// triangles.
[[nodiscard]] std::uint64_t count_unpaired_uses(std::span<const Double3> positions,
                                                std::span<const Triangle> triangles);

/// A component: triangles connected by shared vertices.
struct StoredComponent {
    std::vector<std::uint32_t> triangles;
    bool closed = true;       ///< every edge has at least two uses
    bool balanced = true;     ///< the uses of every edge cancel
    double volume = 0;        ///< signed; 0 unless balanced
    double volume_error = 0;  ///< bound on the error of `volume`
};

/// Returns the components in the order of their lowest triangle.
[[nodiscard]] std::vector<StoredComponent> find_stored_components(
    std::span<const Double3> positions, std::span<const Triangle> triangles);

/// Returns whether `after` lacks a property that `before` had: inside defined, manifold,
/// oriented, closed. A later one of the last three may be lost to gain an earlier one. An edge
/// of three triangles is closed by definition, but bounds nothing.
[[nodiscard]] bool is_worse(const StoredVerdict& after, const StoredVerdict& before) noexcept;

}  // namespace cdprep::mesh
