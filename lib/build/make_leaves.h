// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/build_bvh.h"
#include "kernels/kernels.h"

namespace cdprep::build {

/// The memory into which leaves are written.
struct LeafRoom {
    Frame frame;
    bool exact = false;  ///< the leaves hold model coordinates
    std::span<format::BvhNode> nodes;
    std::span<format::BvhLeaf> leaves;
    /// The places of each leaf that have a triangle, at most eight bits; null: all have one. A leaf
    /// without triangles gets an unused box.
    const std::uint8_t* lanes = nullptr;
    /// Gets bit i, 64 a word, of each place i whose corners are exactly collinear, and of each
    /// place without a triangle. Empty: not wanted.
    std::span<std::uint64_t> degenerate_bits = {};
};

/// Returns the map of a frame as kernels take it.
[[nodiscard]] kernels::LeafMap leaf_map(const Frame& frame);

/// Fills leaves and the boxes around them, which are level 0 of the nodes. Requires triangles in
/// tree order.
void make_leaves(const LeafRoom& room, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, ParallelFor parallel_for);
void make_leaves(const LeafRoom& room, std::span<const format::Float3> positions,
                 std::span<const format::Triangle> triangles, ParallelFor parallel_for);

/// Fills the leaves from `first` up to `last`, and the boxes around them.
void make_some_leaves(const LeafRoom& room, std::span<const format::Double3> positions,
                      std::span<const format::Triangle> triangles, std::size_t first,
                      std::size_t last);
void make_some_leaves(const LeafRoom& room, std::span<const format::Float3> positions,
                      std::span<const format::Triangle> triangles, std::size_t first,
                      std::size_t last);

/// Fills bvh.leaves and the boxes around them, which are level 0 of bvh.nodes, from bvh.order,
/// bvh.frame and bvh.exact_leaves.
void make_leaves(Bvh& bvh, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, ParallelFor parallel_for);

}  // namespace cdprep::build
