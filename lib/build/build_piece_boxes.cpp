// SPDX-License-Identifier: MIT
#include "cdprep/advanced/build_piece_boxes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <utility>

#include "build/make_leaves.h"
#include "build/make_nodes.h"
#include "build/make_oriented.h"
#include "build/make_swept.h"
#include "build/order_triangles.h"
#include "cdprep/format/float_environment.h"
#include "core/guarded_for.h"

namespace cdprep::build {
namespace {

using format::BvhShape;
using format::Double3;
using format::kBvhWidth;
using format::PieceLeaf;

/// Returns the triangles of each piece, in the fewest runs of nearly equal length.
std::vector<PieceLeaf> cut_into_leaves(const PiecesOf& surface) {
    std::vector<PieceLeaf> leaves;
    for (std::uint32_t piece = 0; piece < surface.pieces.size(); ++piece) {
        const std::uint32_t first = surface.pieces[piece].first_triangle;
        const std::size_t end = piece + 1 < surface.pieces.size()
                                    ? surface.pieces[piece + 1].first_triangle
                                    : surface.piece_triangles.size();
        const auto count = static_cast<std::uint32_t>(end - first);
        const std::uint32_t runs = (count + kBvhWidth - 1) / kBvhWidth;
        std::uint32_t at = first;
        for (std::uint32_t run = 0; run < runs; ++run) {
            const std::uint32_t length = count / runs + (run < count % runs ? 1 : 0);
            leaves.push_back({piece, at, length});
            at += length;
        }
    }
    return leaves;
}

/// Returns two opposite corners of the box around a leaf's triangles.
std::array<Double3, 2> box_of(const PiecesOf& surface, const PieceLeaf& leaf) {
    assert(leaf.count > 0 && leaf.count <= kBvhWidth);
    constexpr double kMost = std::numeric_limits<double>::infinity();
    Double3 lower = {kMost, kMost, kMost}, upper = {-kMost, -kMost, -kMost};
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
        const std::uint32_t triangle = surface.piece_triangles[leaf.first_triangle + i];
        for (const std::uint32_t vertex : surface.triangles[triangle].vertex) {
            const Double3& p = surface.positions[vertex];
            lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
            upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
        }
    }
    return {lower, upper};
}

/// Orders the leaves; a triangle with the same box represents each leaf.
void order_leaves(std::vector<PieceLeaf>& leaves, const PiecesOf& surface, const Frame& frame,
                  ParallelFor parallel_for) {
    std::vector<Double3> corners;
    std::vector<format::Triangle> stand_ins;
    for (std::uint32_t i = 0; i < leaves.size(); ++i) {
        const auto box = box_of(surface, leaves[i]);
        corners.insert(corners.end(), box.begin(), box.end());
        stand_ins.push_back({{2 * i, 2 * i + 1, 2 * i}});
    }
    Bvh bvh;
    bvh.frame = frame;
    order_triangles(bvh, corners, stand_ins, {.parallel_for = parallel_for});
    std::vector<PieceLeaf> ordered;
    ordered.reserve(leaves.size());
    for (const std::uint32_t i : bvh.order) ordered.push_back(leaves[i]);
    leaves = std::move(ordered);
}

/// Computes the bounds as for a BVH in which each leaf holds eight triangles; the last triangle
/// repeats.
void bound_leaves(PieceBoxes& made, const PiecesOf& surface, const Frame& frame,
                  ParallelFor parallel_for) {
    const std::vector<PieceLeaf>& leaves = made.leaves;
    const BvhShape shape = format::piece_tree_shape(static_cast<std::uint32_t>(leaves.size()));
    Bvh bvh;
    bvh.frame = frame;
    bvh.order.reserve(leaves.size() * kBvhWidth);
    for (const PieceLeaf& leaf : leaves) {
        for (std::uint32_t lane = 0; lane < kBvhWidth; ++lane) {
            const std::uint32_t i = std::min(lane, leaf.count - 1);
            bvh.order.push_back(surface.piece_triangles[leaf.first_triangle + i]);
        }
    }
    bvh.nodes.resize(shape.node_count);
    bvh.leaves.resize(shape.leaf_count);
    make_leaves(bvh, surface.positions, surface.triangles, parallel_for);
    make_nodes(bvh.nodes, static_cast<std::uint32_t>(bvh.order.size()), parallel_for);
    make_oriented(bvh, parallel_for);
    make_swept(bvh, BvhBounds::swept_rectangles, parallel_for);
    made.nodes = std::move(bvh.nodes);
    made.swept = std::move(bvh.swept_nodes);
}

}  // namespace

PieceBoxes build_piece_boxes(const PiecesOf& surface, const Frame& frame,
                             ParallelFor parallel_for) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, parallel_for);
    PieceBoxes made;
    made.leaves = cut_into_leaves(surface);
    if (made.leaves.size() > format::kMaxPieceLeaves) return {};
    if (made.leaves.empty()) return made;
    order_leaves(made.leaves, surface, frame, guarded);
    bound_leaves(made, surface, frame, guarded);
    return made;
}

}  // namespace cdprep::build
