// SPDX-License-Identifier: MIT
#include "cdprep/build_bvh.h"

#include <cstdlib>

#include "frame_map.h"
#include "make_leaves.h"
#include "make_nodes.h"
#include "make_oriented.h"
#include "make_swept.h"
#include "order_triangles.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::Triangle;

/// Exponents of frames whose scale is an ordinary float.
constexpr std::int32_t kMaxExactExponent = 100;

void set_frame(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
               const ParallelFor& parallel_for) {
    const Extent extent = extent_of(positions, triangles, parallel_for);
    bvh.frame = frame_of(extent);
    bvh.exact_leaves = extent.floats && std::abs(bvh.frame.exponent) <= kMaxExactExponent;
}

/// What the options want besides the axis-aligned boxes.
void fit_bounds(Bvh& bvh, const BvhOptions& options) {
    if (options.bounds != BvhBounds::aligned) {
        make_oriented(bvh, options.parallel_for);
    } else {
        bvh.oriented_nodes.clear();
    }
    if (options.bounds > BvhBounds::oriented) {
        make_swept(bvh, options.bounds, options.parallel_for);
    } else {
        bvh.swept_nodes.clear();
        bvh.swept_kind = format::SweptKind::point;
    }
}

/// Everything that follows from frame and order.
void fill_nodes(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
                const BvhOptions& options) {
    const auto shape = format::bvh_shape(static_cast<std::uint32_t>(triangles.size()));
    bvh.nodes.resize(shape.node_count);
    bvh.leaves.resize(shape.leaf_count);
    make_leaves(bvh, positions, triangles, options.parallel_for);
    make_nodes(bvh, options.parallel_for);
    fit_bounds(bvh, options);
}

}  // namespace

void serial_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = 0; i < count; ++i) body(i);
}

void rebuild_bvh(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
                 const BvhOptions& options) {
    if (triangles.empty()) {
        bvh = Bvh{};
        return;
    }
    set_frame(bvh, positions, triangles, options.parallel_for);
    order_triangles(bvh, positions, triangles, options);
    fill_nodes(bvh, positions, triangles, options);
}

Bvh build_bvh(std::span<const Double3> positions, std::span<const Triangle> triangles,
              const BvhOptions& options) {
    Bvh bvh;
    rebuild_bvh(bvh, positions, triangles, options);
    return bvh;
}

}  // namespace cdprep::build
