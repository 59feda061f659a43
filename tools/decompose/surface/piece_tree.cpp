// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/piece_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "cdprep/advanced/build_piece_boxes.h"

#include "hull/convex_hull.h"
#include "hull/enclosing_hull.h"

namespace cdprep::convex {
namespace {

using format::BvhShape;
using format::kBvhWidth;
using format::kHullLanes;
using format::PieceLeaf;
using format::PieceNodeHull;

struct PointBox {
    Double3 lower;
    Double3 upper;
};

PointBox box_of(std::span<const Double3> points) {
    constexpr double kMost = std::numeric_limits<double>::infinity();
    PointBox box = {{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
    for (const Double3& p : points) {
        box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                     std::min(box.lower.z, p.z)};
        box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                     std::max(box.upper.z, p.z)};
    }
    return box;
}

/// Adds the corners of a leaf's triangles.
void append(const PieceLeaf& leaf, const mesh::Mesh& mesh, const PieceArrays& pieces,
            std::vector<Double3>& points) {
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
        const std::uint32_t triangle = pieces.triangles[leaf.first_triangle + i];
        for (const std::uint32_t vertex : mesh.triangles[triangle].vertex) {
            points.push_back(mesh.positions[vertex]);
        }
    }
}

std::vector<Double3> corners_of(const PointBox& box) {
    std::vector<Double3> corners;
    for (unsigned bits = 0; bits < 8; ++bits) {
        corners.push_back({(bits & 1) != 0 ? box.upper.x : box.lower.x,
                           (bits & 2) != 0 ? box.upper.y : box.lower.y,
                           (bits & 4) != 0 ? box.upper.z : box.lower.z});
    }
    return corners;
}

PieceNodeHull stored(std::span<const Double3> corners, double slack) {
    PieceNodeHull hull{};
    hull.count = static_cast<std::uint32_t>(corners.size());
    hull.slack = slack;
    for (std::size_t i = 0; i < format::kPieceHullCorners; ++i) {
        const Double3& p = corners[std::min(i, corners.size() - 1)];
        auto& at = hull.block[i / kHullLanes].at;
        const std::size_t lane = i % kHullLanes;
        at[0][lane] = p.x;
        at[1][lane] = p.y;
        at[2][lane] = p.z;
    }
    return hull;
}

/// Returns an enclosing hull of an exact hull; a box if its coordinates are too large for planes.
PieceNodeHull around(const ConvexHull& exact) {
    const std::optional<EnclosingHull> enclosing = enclosing_hull(exact, format::kPieceHullCorners);
    if (enclosing) return stored(enclosing->hull.points, enclosing->distance);
    const PointBox box = box_of(exact.points);
    // Coordinates may be near double's upper range: halved, their squares stay in it.
    constexpr double kHalf = 0.5;
    constexpr double kRoundedUp = 1 + 0x1p-50;  // more than the roundings of the diagonal
    const double half = std::hypot(kHalf * box.upper.x - kHalf * box.lower.x,
                                   kHalf * box.upper.y - kHalf * box.lower.y,
                                   kHalf * box.upper.z - kHalf * box.lower.z);
    return stored(corners_of(box), half / kHalf * kRoundedUp);
}

/// Builds the hulls level by level, from the points of the exact hulls below.
std::vector<PieceNodeHull> hulls_around(const std::vector<PieceLeaf>& leaves,
                                        const mesh::Mesh& mesh, const PieceArrays& pieces,
                                        ParallelFor parallel_for) {
    const BvhShape shape = format::piece_tree_shape(static_cast<std::uint32_t>(leaves.size()));
    std::vector<PieceNodeHull> hulls(format::piece_hull_count(shape));
    std::vector<std::vector<Double3>> below;
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        std::vector<std::vector<Double3>> here(shape.count[level]);
        parallel_for(here.size(), [&](std::size_t node) {
            std::vector<Double3> held;
            const auto number = static_cast<std::uint32_t>(node);
            const std::uint32_t used = shape.used_boxes(level, number);
            for (std::size_t i = node * kBvhWidth; i < node * kBvhWidth + used; ++i) {
                if (level == 0) {
                    append(leaves[i], mesh, pieces, held);
                } else {
                    held.insert(held.end(), below[i].begin(), below[i].end());
                }
            }
            ConvexHull exact = convex_hull(held);
            const std::uint32_t place = shape.first[level] + number;
            if (place < hulls.size()) hulls[place] = around(exact);
            here[node] = std::move(exact.points);
        });
        below = std::move(here);
    }
    return hulls;
}

}  // namespace

PieceTree make_piece_tree(const mesh::Mesh& mesh, const PieceArrays& pieces,
                          const build::Frame& frame, ParallelFor parallel_for) {
    build::PieceBoxes boxes = build::build_piece_boxes(
        {mesh.positions, mesh.triangles, pieces.pieces, pieces.triangles}, frame, parallel_for);
    PieceTree tree = {std::move(boxes.nodes), std::move(boxes.swept), std::move(boxes.leaves), {}};
    tree.hulls = hulls_around(tree.leaves, mesh, pieces, parallel_for);
    return tree;
}

}  // namespace cdprep::convex
