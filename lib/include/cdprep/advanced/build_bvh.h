// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/geometry.h"

namespace cdprep::build {

/// The map from model coordinates to box coordinates:
/// (x - origin) * 2^exponent, in [-1, 1].
struct Frame {
    format::Double3 origin = {0, 0, 0};
    std::int32_t exponent = 0;
};

struct Bvh {
    Frame frame;
    /// order[i] is the input triangle that stands i-th in tree order.
    std::vector<std::uint32_t> order;
    /// As format::BvhNode and format::bvh_shape(order.size()) say.
    std::vector<format::BvhNode> nodes;
    /// As format::BvhLeaf says; one per eight triangles of the tree order.
    std::vector<format::BvhLeaf> leaves;
    /// Whether the leaves hold model coordinates: every coordinate is a float.
    bool exact_leaves = false;
    /// As many as nodes, or none.
    std::vector<format::OrientedNode> oriented_nodes;
    /// As many as nodes, or none; swept_kind says what they are, a point without any.
    std::vector<format::SweptNode> swept_nodes;
    format::SweptKind swept_kind = format::SweptKind::point;
};

/// What questions about two models look at besides the axis-aligned boxes. The answers
/// are the same with all. Oriented boxes are the fastest for overlap and collisions, by
/// little, swept rectangles for distance and tolerance, by 1.1 to 1.3 times; the others
/// lose nearly everywhere (FORMAT.md has the table). A tree with swept ones takes 1.5 to 4
/// times as long to build.
enum class BvhBounds : std::uint8_t {
    aligned,           ///< nothing: 3.4 bytes a triangle
    oriented,          ///< oriented boxes: 6.9 bytes a triangle more
    swept_points,      ///< spheres: as much, of which a third is read
    swept_lines,       ///< capsules: two thirds
    swept_rectangles,  ///< rectangles with a radius
    /// Both, 13.7 bytes more: the boxes for overlap and collisions, the rectangles for distance.
    oriented_and_swept,
};

/// Returns those whose swept spheres are of one kind.
[[nodiscard]] constexpr BvhBounds swept_bounds(format::SweptKind kind) noexcept {
    return static_cast<BvhBounds>(static_cast<std::uint32_t>(BvhBounds::swept_points) +
                                  static_cast<std::uint32_t>(kind));
}

/// What a build takes time for.
enum class Quality : std::uint8_t {
    /// For hierarchies that are kept. Of the cuts between full subtrees the one of
    /// least cost by the surface-area heuristic, along any axis: over 32 bins, and
    /// exactly in sets of up to 64.
    best,
    /// For objects rebuilt at run time. Halves, as nearly as full subtrees allow,
    /// across the longest axis. On scans surface_cost() is 5 to 15 % higher, collide() and
    /// overlaps() takes 2 to 9 % longer in the median and 60 % at worst, the
    /// build takes two fifths of the time.
    fast,
};

struct BvhOptions {
    ParallelFor parallel_for = serial_for;
    /// Overlap queries take 1.1 to 1.3 times as long without oriented boxes, 1.3 to 1.5
    /// times when fast.
    BvhBounds bounds = BvhBounds::oriented;
    Quality quality = Quality::best;
};

/// Builds the packed hierarchy of BvhNode, top-down, every node but the last of each
/// level full. Boxes are rounded outwards. The result depends on the input and on
/// options.quality and options.bounds alone: the same bytes for any parallel_for,
/// any standard library and any machine.
///
/// `positions` must be finite and at most format::kMaxCoordinate; triangles may
/// be degenerate or equal. Middles that are equal along all axes, to 2^-100 of the
/// model, are cut by number. O(n log n); scratch of 64 bytes per triangle, 32 when
/// fast. tests/bench/build_bvh_bench measures.
[[nodiscard]] Bvh build_bvh(std::span<const format::Double3> positions,
                            std::span<const format::Triangle> triangles,
                            const BvhOptions& options = {});

/// The same, into the arrays that `bvh` has: those that are large enough are not
/// allocated anew, which spares a tenth of the time of a fast build, and more of one on
/// several threads.
void rebuild_bvh(Bvh& bvh, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const BvhOptions& options = {});

/// Returns what the surface-area heuristic says of a hierarchy: the area of all used
/// boxes by that of the box around everything, which is how many boxes a random line
/// through that one passes, 1 at least. Less is better; compare hierarchies over the same
/// triangles. 0 when there are no triangles, or all lie on a line. O(nodes).
[[nodiscard]] double surface_cost(const Bvh& bvh) noexcept;
[[nodiscard]] double surface_cost(std::span<const format::BvhNode> nodes) noexcept;

}  // namespace cdprep::build
