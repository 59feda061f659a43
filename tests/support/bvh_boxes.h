// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "support/aligned_bytes.h"
#include "support/exact_rational.h"
#include "support/meshes.h"

#include "cdprep/advanced/build_bvh.h"

namespace cdprep::test {

inline ExactNumber in_frame(double x, double origin, std::int32_t exponent) {
    ExactNumber value = ExactNumber(x) - ExactNumber(origin);
    // Two steps, so that neither power of two leaves the range of double.
    value = value * ExactNumber(std::ldexp(1.0, exponent / 2));
    return value * ExactNumber(std::ldexp(1.0, exponent - exponent / 2));
}

/// Returns true if box `box` of a node contains one triangle, in exact arithmetic.
inline bool box_holds(const format::BvhNode& node, std::uint32_t box, const TestMesh& mesh,
                      std::uint32_t triangle, const build::Frame& frame) {
    const double origin[3] = {frame.origin.x, frame.origin.y, frame.origin.z};
    for (const std::uint32_t v : mesh.triangles[triangle].vertex) {
        const Double3& p = mesh.positions[v];
        const double x[3] = {p.x, p.y, p.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const ExactNumber at = in_frame(x[axis], origin[axis], frame.exponent);
            if (!(ExactNumber(node.lower[axis][box]) <= at)) return false;
            if (!(at <= ExactNumber(node.upper[axis][box]))) return false;
        }
    }
    return true;
}

/// Returns true if every used box of every level contains every triangle below it, and no
/// triangle is missing.
inline bool boxes_hold_all(const TestMesh& mesh, const build::Bvh& bvh) {
    const auto count = static_cast<std::uint32_t>(bvh.order.size());
    const format::BvhShape shape = format::bvh_shape(count);
    if (count != mesh.triangles.size() || bvh.nodes.size() != shape.node_count) return false;
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t place = i >> (3 * (level + 1));  // of 8 to the power level + 1
            const format::BvhNode& node = bvh.nodes[shape.first[level] + place / format::kBvhWidth];
            if (!box_holds(node, place % format::kBvhWidth, mesh, bvh.order[i], bvh.frame)) {
                return false;
            }
        }
    }
    return true;
}

inline bool same_bytes(const build::Bvh& a, const build::Bvh& b) {
    return a.frame.origin == b.frame.origin && a.frame.exponent == b.frame.exponent &&
           a.exact_leaves == b.exact_leaves && same_bytes(a.order, b.order) &&
           same_bytes(a.nodes, b.nodes) && same_bytes(a.leaves, b.leaves) &&
           same_bytes(a.oriented_nodes, b.oriented_nodes) && a.swept_kind == b.swept_kind &&
           same_bytes(a.swept_nodes, b.swept_nodes);
}

}  // namespace cdprep::test
