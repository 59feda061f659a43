// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/api.h"
#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/geometry.h"

namespace cdprep::build {

/// The map from model coordinates x to box coordinates: (x - origin) * 2^exponent. Box coordinates
/// lie in [-1, 1].
struct Frame {
    format::Double3 origin = {0, 0, 0};
    std::int32_t exponent = 0;
};

struct Bvh {
    Frame frame;
    /// order[i] is the number of the input triangle at place i of the tree order.
    std::vector<std::uint32_t> order;
    /// The nodes, with the content of format::BvhNode and the shape
    /// format::bvh_shape(order.size()).
    std::vector<format::BvhNode> nodes;
    /// The leaves, with the content of format::BvhLeaf: one per eight triangles of the tree order.
    std::vector<format::BvhLeaf> leaves;
    /// True if the leaves hold model coordinates without rounding. This requires that every
    /// coordinate is a float.
    bool exact_leaves = false;
    /// The oriented boxes: one element for each of `nodes`, or empty.
    std::vector<format::OrientedNode> oriented_nodes;
    /// The swept spheres: one element for each of `nodes`, or empty. swept_kind is their kind, or
    /// SweptKind::point if there are none.
    std::vector<format::SweptNode> swept_nodes;
    format::SweptKind swept_kind = format::SweptKind::point;
};

/// The bounds that queries about two models use besides the axis-aligned boxes. The answers do not
/// depend on the choice. Oriented boxes are the fastest for overlap and for models that collide, by
/// a small margin. Swept rectangles are slightly faster if models narrowly miss each other. For
/// distance and tolerance queries, swept rectangles are 1.1 to 1.3 times as fast as oriented boxes.
/// The other bounds are slower nearly everywhere (table in FORMAT.md). A BVH with swept bounds
/// takes 1.5 to 4 times as long to build as one without.
enum class BvhBounds : std::uint8_t {
    aligned,           ///< no other bounds: the nodes take 3.4 bytes per triangle
    oriented,          ///< oriented boxes: 6.9 bytes per triangle more
    swept_points,      ///< spheres: 6.9 bytes per triangle more; queries read a third of these
    swept_lines,       ///< capsules: 6.9 bytes per triangle more; queries read two thirds of these
    swept_rectangles,  ///< rectangles with a radius: 6.9 bytes per triangle more
    /// Oriented boxes for overlap and collisions, and rectangles for distance: 13.7 bytes per
    /// triangle more.
    oriented_and_swept,
};

/// Returns the bounds with swept spheres of one kind and without oriented boxes.
[[nodiscard]] constexpr BvhBounds swept_bounds(format::SweptKind kind) noexcept {
    return static_cast<BvhBounds>(static_cast<std::uint32_t>(BvhBounds::swept_points) +
                                  static_cast<std::uint32_t>(kind));
}

/// The trade-off between build time and query time.
enum class Quality : std::uint8_t {
    /// For a BVH that is built once and used often. Chooses the split of least cost by the
    /// surface-area heuristic. A split may be along any axis, but only between full subtrees. The
    /// cost is exact for sets of up to 64 triangles, and estimated from 32 bins for larger sets.
    best,
    /// For objects that are rebuilt at run time. Splits along the longest axis, into triangle
    /// counts as nearly equal as full subtrees allow. The build takes two fifths of the time of
    /// Quality::best. On scans, surface_cost() is 5 to 15 % higher. Queries of collide() and
    /// overlaps() take 2 to 9 % longer in the median. The slowest measured query took 60 % longer.
    fast,
};

struct BvhOptions {
    ParallelFor parallel_for = serial_for;
    /// Without oriented boxes, overlap queries take 1.1 to 1.3 times as long. In a BVH of
    /// Quality::fast, they take 1.3 to 1.5 times as long.
    BvhBounds bounds = BvhBounds::oriented;
    Quality quality = Quality::best;
};

/// Builds the packed BVH that format::BvhNode describes, from the top down. On each level, every
/// node but the last is full. Boxes are rounded outwards. The result depends only on the input,
/// options.quality and options.bounds. It is the same, byte for byte, for any parallel_for,
/// standard library and machine.
///
/// Triangles may be degenerate or equal. Triangles whose boxes have equal middles are split by
/// number. Coordinates in `positions` must be finite and at most format::kMaxCoordinate in
/// magnitude.
///
/// Takes O(n log n) time and 64 bytes of scratch memory per triangle, or 32 with Quality::fast.
/// tests/bench/build_bvh_bench measures the time.
[[nodiscard]] CDPREP_API Bvh build_bvh(std::span<const format::Double3> positions,
                                       std::span<const format::Triangle> triangles,
                                       const BvhOptions& options = {});

/// Builds the same BVH in the arrays of `bvh`. Arrays that are large enough are not allocated
/// again. This saves a tenth of the time of a fast build, and a larger share on several threads.
CDPREP_API void rebuild_bvh(Bvh& bvh, std::span<const format::Double3> positions,
                            std::span<const format::Triangle> triangles,
                            const BvhOptions& options = {});

/// Returns the cost of a BVH by the surface-area heuristic. It is the sum of the areas of all used
/// boxes, divided by the area of the box around everything. It equals the expected number of boxes
/// that a random line through that box crosses. Returns 0 if there are no triangles, or if all lie
/// on a line parallel to a coordinate axis. Lower is better. Compare only BVHs over the same
/// triangles. Takes O(nodes) time.
[[nodiscard]] CDPREP_API double surface_cost(const Bvh& bvh) noexcept;
[[nodiscard]] CDPREP_API double surface_cost(std::span<const format::BvhNode> nodes) noexcept;

}  // namespace cdprep::build
