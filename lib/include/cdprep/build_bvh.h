// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/geometry.h"

namespace cdprep::build {

/// Runs body(0) ... body(count - 1), in any order, on any threads, and returns
/// when all are done. The library starts no threads: this is the caller's.
using ParallelFor =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// Runs them one after the other.
void serial_for(std::size_t count, const std::function<void(std::size_t)>& body);

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
    best,  ///< for hierarchies that are kept
    fast,  ///< for objects rebuilt at run time
};

struct BvhOptions {
    ParallelFor parallel_for = serial_for;
    BvhBounds bounds = BvhBounds::oriented;
    Quality quality = Quality::best;
};

/// Builds the packed hierarchy of BvhNode.
///
/// Splits top-down by the surface-area heuristic over 16 bins per axis, with the
/// left part's size rounded to a whole subtree, so that every node but the last
/// of each level is full. Equal centroids split by number. Boxes are rounded
/// outwards. The result depends on the input alone, never on parallel_for.
///
/// `positions` must be finite and at most format::kMaxCoordinate; triangles may
/// be degenerate or equal. O(n log n); about 40 bytes of scratch per triangle.
[[nodiscard]] Bvh build_bvh(std::span<const format::Double3> positions,
                            std::span<const format::Triangle> triangles,
                            const BvhOptions& options = {});

/// The same, into the arrays that `bvh` has: what is large enough is not allocated
/// anew, which spares an eighth of the time of a fast build.
void rebuild_bvh(Bvh& bvh, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const BvhOptions& options = {});

}  // namespace cdprep::build
