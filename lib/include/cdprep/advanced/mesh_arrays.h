// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/api.h"
#include "cdprep/format/file_header.h"

// The separate steps from a mesh to the arrays of a model. build_model() runs them all. Triangles
// share a vertex only if they use the same vertex number: equal positions are not welded.
namespace cdprep::build {

/// A mesh rearranged for the BVH.
struct TreeOrder {
    std::vector<format::Triangle> triangles;  ///< tree order, with new vertex numbers
    std::vector<std::uint32_t> vertices;      ///< the input vertex at each new place
    std::vector<std::uint32_t> new_vertex;    ///< the place of each input vertex, or kUnused
    static constexpr std::uint32_t kUnused = 0xffffffffU;
};

/// Puts triangle order[i] at place i and numbers vertices by first use. Neighbours in the tree are
/// then neighbours in memory. Vertices that no triangle uses are left out. `order` must be a
/// permutation of the triangles. Takes O(n) time.
[[nodiscard]] CDPREP_API TreeOrder in_tree_order(std::size_t vertex_count,
                                                 std::span<const format::Triangle> triangles,
                                                 std::span<const std::uint32_t> order);

/// The components of a mesh: sets of triangles connected by shared vertices.
struct ComponentNumbers {
    std::size_t count = 0;
    /// The number of each vertex's component. Components are numbered in the order of their lowest
    /// triangle numbers. The number is TreeOrder::kUnused for a vertex that no triangle uses.
    std::vector<std::uint32_t> of_vertex;
};

/// Numbers the components. Takes O(n log n) time at most, and about O(n) for usual meshes.
[[nodiscard]] CDPREP_API ComponentNumbers
number_components(std::size_t vertex_count, std::span<const format::Triangle> triangles);

struct Topology {
    /// The components, in the order of their lowest triangle number.
    std::vector<format::Component> components;
    /// The surface is balanced: the directed uses of every edge cancel, so winding numbers exist.
    bool balanced = false;
};

/// Finds the connected components: triangles connected through shared vertices. Finds whether each
/// component is balanced: every edge is used equally often in both directions. A side between two
/// equal vertex numbers does not count as an edge. A mesh without triangles is balanced. Volumes of
/// components are clamped to the range of double. A volume is 0 if it overflows to NaN, or if the
/// component is not balanced. Takes the time of number_components(), O(n), plus a sort of the edges
/// at each vertex.
[[nodiscard]] CDPREP_API Topology find_topology(std::span<const format::Double3> positions,
                                                std::span<const format::Triangle> triangles);

/// Returns one bit per triangle, 64 per word. A bit is set if the corners are exactly collinear.
/// Returns no words if no triangle is degenerate. Takes O(n) time.
[[nodiscard]] CDPREP_API std::vector<std::uint64_t> find_degenerate(
    std::span<const format::Double3> positions, std::span<const format::Triangle> triangles,
    ParallelFor parallel_for = serial_for);

}  // namespace cdprep::build
