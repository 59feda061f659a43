// SPDX-License-Identifier: MIT
#include "cdprep/advanced/build_bvh.h"

#include "build/frame_map.h"
#include "build/lanes.h"
#include "build/make_leaves.h"
#include "build/make_nodes.h"
#include "build/make_oriented.h"
#include "build/make_swept.h"
#include "build/order_triangles.h"
#include "cdprep/advanced/refit_bvh.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/precondition.h"
#include "core/guarded_for.h"

namespace cdprep::build {
namespace {

using format::BvhNode;
using format::Double3;
using format::kBvhWidth;
using format::Triangle;

void set_frame(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
               ParallelFor parallel_for) {
    const Extent extent = extent_of(positions, triangles, parallel_for);
    bvh.frame = frame_of(extent);
    bvh.exact_leaves = has_exact_leaves(extent.floats, bvh.frame);
}

/// Computes the bounds that the options select besides the axis-aligned boxes.
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

/// Computes everything that follows from frame and order.
void fill_nodes(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
                const BvhOptions& options) {
    const auto shape = format::bvh_shape(static_cast<std::uint32_t>(triangles.size()));
    bvh.nodes.resize(shape.node_count);
    bvh.leaves.resize(shape.leaf_count);
    make_leaves(bvh, positions, triangles, options.parallel_for);
    make_nodes(bvh.nodes, static_cast<std::uint32_t>(triangles.size()), options.parallel_for);
    fit_bounds(bvh, options);
}

}  // namespace

void rebuild_bvh(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
                 const BvhOptions& options) {
    format::FloatEnvironment environment;
    if (triangles.empty()) {
        bvh = Bvh{};
        return;
    }
    const GuardedFor guarded(environment, options.parallel_for);
    const BvhOptions inside = {guarded, options.bounds, options.quality};
    set_frame(bvh, positions, triangles, guarded);
    order_triangles(bvh, positions, triangles, inside);
    fill_nodes(bvh, positions, triangles, inside);
}

Bvh build_bvh(std::span<const Double3> positions, std::span<const Triangle> triangles,
              const BvhOptions& options) {
    Bvh bvh;
    rebuild_bvh(bvh, positions, triangles, options);
    return bvh;
}

double refit_bvh(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
                 const BvhOptions& options) {
    format::FloatEnvironment environment;
    if (bvh.order.size() != triangles.size()) {
        stop_with("The BVH was not built over these triangles: their numbers differ.");
    }
    if (triangles.empty()) return 0;
    const GuardedFor guarded(environment, options.parallel_for);
    set_frame(bvh, positions, triangles, guarded);
    fill_nodes(bvh, positions, triangles, {guarded, options.bounds, options.quality});
    return surface_cost(bvh);
}

double surface_cost(const Bvh& bvh) noexcept {
    return surface_cost(bvh.nodes);
}

double surface_cost(std::span<const BvhNode> nodes) noexcept {
    const format::FloatEnvironment environment;
    if (nodes.empty()) return 0;
    Lanes<double, kBvhWidth> sum{};
    for (const BvhNode& node : nodes) {
        const Lanes<double, kBvhWidth> area = half_areas(node);
        for_lanes<kBvhWidth>([&](std::size_t box) { sum[box] += area[box]; });
    }
    double total = 0;
    for (const double area : sum) total += area;
    const double whole = half_area_around(nodes[0]);
    return whole > 0 ? total / whole : 0;
}

}  // namespace cdprep::build
