// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/file_header.h"

// The steps from a mesh to the arrays of a model, each on its own. build_model.h runs them
// all. Vertices are shared as the triangles share them: equal positions are not welded.
namespace cdprep::build {

/// A mesh rearranged for the hierarchy.
struct TreeOrder {
    std::vector<format::Triangle> triangles;  ///< tree order, with the new numbers of vertices
    std::vector<std::uint32_t> vertices;      ///< vertices[i]: the input vertex that stands i-th
    std::vector<std::uint32_t> new_vertex;    ///< of each input vertex, kUnused when not used
    static constexpr std::uint32_t kUnused = 0xffffffffU;
};

/// Puts triangle order[i] at place i and numbers vertices by first use, so that neighbours in
/// the tree are neighbours in memory. Vertices that no triangle uses are left out. `order` is
/// a permutation of the triangles. O(n).
[[nodiscard]] TreeOrder in_tree_order(std::size_t vertex_count,
                                      std::span<const format::Triangle> triangles,
                                      std::span<const std::uint32_t> order);

/// Components: sets of triangles connected by shared vertices.
struct ComponentNumbers {
    std::size_t count = 0;
    /// In the order of their lowest triangle. Of a vertex that no triangle uses:
    /// TreeOrder::kUnused.
    std::vector<std::uint32_t> of_vertex;
};

/// Numbers the components. O(n).
[[nodiscard]] ComponentNumbers number_components(std::size_t vertex_count,
                                                 std::span<const format::Triangle> triangles);

struct Topology {
    /// As format::Component says, in the order of their lowest triangle.
    std::vector<format::Component> components;
    /// The oriented uses of every edge cancel: winding numbers are defined.
    bool closed = false;
};

/// Finds the connected components (triangles that share a vertex) and whether each is closed:
/// every edge used as often in one direction as in the other. Corners that repeat add
/// nothing. A mesh without triangles is closed. Volumes beyond the largest double are cut to
/// it. O(n), with a sort of the edges at each vertex.
[[nodiscard]] Topology find_topology(std::span<const format::Double3> positions,
                                     std::span<const format::Triangle> triangles);

/// Returns one bit per triangle, 64 a word, set where the corners are exactly collinear; no
/// words at all when none is. O(n).
[[nodiscard]] std::vector<std::uint64_t> find_degenerate(
    std::span<const format::Double3> positions, std::span<const format::Triangle> triangles,
    ParallelFor parallel_for = serial_for);

}  // namespace cdprep::build
