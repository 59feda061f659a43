// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Half-edge 3 t + k runs along triangle t from its corner k to the next. The same number
/// names that corner.
using HalfEdge = std::uint32_t;

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
/// The corner that a half-edge's triangle has besides.
[[nodiscard]] inline std::uint32_t apex_of(std::span<const Triangle> triangles, HalfEdge h) {
    return start_of(triangles, previous_in_triangle(h));
}

[[nodiscard]] bool repeats_corner(const Triangle& triangle) noexcept;

/// All half-edges by the edge that they run along, edges in the order of their lower, then
/// upper vertex, uses of one edge in the order of their numbers. Triangles that repeat a
/// corner have none.
struct EdgeUses {
    std::vector<HalfEdge> use;
    std::vector<std::uint32_t> first;  ///< of each edge, in `use`; one more at the end

    [[nodiscard]] std::size_t edge_count() const {
        return first.size() - 1;
    }
    [[nodiscard]] std::span<const HalfEdge> of(std::size_t edge) const {
        return std::span(use).subspan(first[edge], first[edge + 1] - first[edge]);
    }
};

/// O(n), and n log n in the degree of a vertex.
[[nodiscard]] EdgeUses find_edge_uses(std::span<const Triangle> triangles,
                                      std::size_t vertex_count);

/// Joins numbers into groups; the lowest of a group stands for it.
class Groups {
public:
    explicit Groups(std::size_t count);
    [[nodiscard]] std::uint32_t lowest(std::uint32_t member);
    /// True when they were apart.
    bool join(std::uint32_t a, std::uint32_t b);

private:
    std::vector<std::uint32_t> parent_;
};

/// For each half-edge the one that it is joined to, or kNone at a boundary: those of
/// edges that are used once in either direction and no more.
[[nodiscard]] std::vector<HalfEdge> find_twins(std::span<const Triangle> triangles,
                                               const EdgeUses& edges);

/// For each corner, by its half-edge, the lowest corner of its fan: of the triangles
/// around its vertex that `twins` joins to each other.
[[nodiscard]] std::vector<std::uint32_t> find_fans(std::span<const HalfEdge> twins);

}  // namespace cdprep::mesh
