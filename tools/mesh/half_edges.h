// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Half-edge 3 t + k runs along triangle t from its corner k to the next. Its number is also
/// that of the corner.
using HalfEdge = std::uint32_t;

/// The most triangles whose half-edges have numbers below kNone. Imports refuse more.
inline constexpr std::uint32_t kMostMeshTriangles = kNone / 3;

[[nodiscard]] constexpr HalfEdge next_in_triangle(HalfEdge h) noexcept {
    return h % 3 == 2 ? h - 2 : h + 1;
}
[[nodiscard]] constexpr HalfEdge previous_in_triangle(HalfEdge h) noexcept {
    return h % 3 == 0 ? h + 2 : h - 1;
}
[[nodiscard]] inline std::uint32_t start_of(std::span<const Triangle> triangles, HalfEdge h) {
    return triangles[h / 3].vertex[h % 3];
}
[[nodiscard]] inline std::uint32_t end_of(std::span<const Triangle> triangles, HalfEdge h) {
    return start_of(triangles, next_in_triangle(h));
}
/// Returns the third corner of a half-edge's triangle.
[[nodiscard]] inline std::uint32_t apex_of(std::span<const Triangle> triangles, HalfEdge h) {
    return start_of(triangles, previous_in_triangle(h));
}

[[nodiscard]] bool repeats_corner(const Triangle& triangle) noexcept;

/// All half-edges, grouped by their edge. Edges are ordered by lower, then upper vertex; the
/// uses of one edge, by number. Triangles that repeat a corner have none.
struct EdgeUses {
    std::vector<HalfEdge> use;
    std::vector<std::uint32_t> first;  ///< start of each edge in `use`; one more at the end

    [[nodiscard]] std::size_t edge_count() const {
        return first.size() - 1;
    }
    [[nodiscard]] std::span<const HalfEdge> of(std::size_t edge) const {
        return std::span(use).subspan(first[edge], first[edge + 1] - first[edge]);
    }
};

/// Returns the uses. O(n), and n log n in the degree of a vertex. Throws std::length_error for more
/// than kMostMeshTriangles triangles.
[[nodiscard]] EdgeUses find_edge_uses(std::span<const Triangle> triangles,
                                      std::size_t vertex_count);

/// Joins numbers into groups; the lowest one represents its group.
class Groups {
public:
    explicit Groups(std::size_t count);
    [[nodiscard]] std::uint32_t lowest(std::uint32_t member);
    /// Returns whether the two were in different groups.
    bool join(std::uint32_t a, std::uint32_t b);

private:
    std::vector<std::uint32_t> parent_;
};

/// Returns for each half-edge the one joined to it, or kNone at a boundary. Half-edges are
/// joined at edges that are used exactly once in each direction.
[[nodiscard]] std::vector<HalfEdge> find_twins(std::span<const Triangle> triangles,
                                               const EdgeUses& edges);

/// Returns for each corner, by its half-edge, the lowest corner of its fan. A fan consists of
/// the triangles around a vertex that `twins` joins to each other.
[[nodiscard]] std::vector<std::uint32_t> find_fans(std::span<const HalfEdge> twins);

}  // namespace cdprep::mesh
