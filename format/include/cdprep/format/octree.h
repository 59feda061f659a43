// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"

namespace cdprep::format {

/// The number of bits of a coordinate along an edge of an octree's cube. An edge has 2^21 steps. A
/// key of 21 levels fills 64 bits: a leading one, then three bits per level.
inline constexpr std::uint32_t kOctreeBits = 21;

/// The bit of a reference that is set if other leaves of the same tree list its triangle too. The
/// other bits are the triangle's place in tree order.
inline constexpr std::uint32_t kSharedReference = 0x80000000U;

/// The bit of OctreeNode::count and AdaptiveOctreeNode::count for a node with children; the low
/// eight bits are the set of children. Without this bit, the node is a leaf and `count` is its
/// number of references.
inline constexpr std::uint32_t kInnerNode = 0x80000000U;

/// The factor by which octree_mixed_table multiplies keys: 2^64 divided by the golden ratio,
/// rounded to an odd number.
inline constexpr std::uint64_t kKeyMixer = 0x9e3779b97f4a7c15U;

/// The cube that an octree divides, and the limits of the division.
///
/// Plane i of an axis, 0 <= i <= 2^21, lies at origin + i * step. The product is exact, because
/// step has at most 32 significant bits. The sum is rounded to double once. The rounded sum is the
/// plane's coordinate by definition, and it increases strictly with i. A cell of level l is the
/// closed box between planes i and i + 2^(21 - l) of each axis. The root, level 0, contains every
/// vertex and extends more than one step beyond. So the bounds of cells are exact on every level,
/// whatever the model's size.
struct OctreeGrid {
    Double3 origin;           ///< model units
    double step;              ///< model units, > 0
    std::uint32_t level;      ///< no node is deeper; at most kOctreeBits
    std::uint32_t threshold;  ///< a cell with fewer triangles is not divided
    std::uint32_t top_level;  ///< the level of the cells in octree_top; at most `level`
    std::uint32_t slot_bits;  ///< 2^slot_bits slots in each hash table
};

/// A cell that some triangle touches. Nodes are sorted by `key`: level by level, and along the
/// Z-order curve within a level. The root, key 1, is first. A model without triangles has no nodes.
struct OctreeNode {
    /// A leading one, then three bits per level from the root down. Of the three, bit 0 is set in
    /// the upper half along x, bit 1 along y, bit 2 along z. The parent is key >> 3.
    std::uint64_t key;
    /// For a leaf: its first reference. For an inner node: its first child. The children are
    /// consecutive, in the order of their last three key bits.
    std::uint32_t first;
    std::uint32_t count;  ///< kInnerNode | mask of children, or number of references
};

/// Returns the level of a key with a leading one. Returns 0 if `key` is 0, which is not a valid
/// key.
constexpr std::uint32_t level_of(std::uint64_t key) noexcept {
    return static_cast<std::uint32_t>(std::bit_width(key | 1) - 1) / 3;
}

/// Returns a key without its leading one, shifted up to kOctreeBits levels. The key's cell contains
/// cells of level kOctreeBits; the result is the first one's position along the Z-order curve.
constexpr std::uint64_t code_of(std::uint64_t key) noexcept {
    const std::uint32_t level = level_of(key);
    const std::uint64_t path = key ^ (std::uint64_t{1} << (3 * level));
    return path << (3 * (kOctreeBits - level));
}

/// Returns the number of cells of level kOctreeBits in a cell of this level.
constexpr std::uint64_t cells_below(std::uint32_t level) noexcept {
    return std::uint64_t{1} << (3 * (kOctreeBits - level));
}

/// Return the slot of a key: modulus_slot() in octree_modulus_table, mixed_slot() in
/// octree_mixed_table.
constexpr std::uint64_t modulus_slot(std::uint64_t key, std::uint32_t slot_bits) noexcept {
    return key & ((std::uint64_t{1} << slot_bits) - 1);
}
constexpr std::uint64_t mixed_slot(std::uint64_t key, std::uint32_t slot_bits) noexcept {
    // Two shifts, because a shift by 64 is not allowed, and there may be only one slot.
    return (key * kKeyMixer) >> 1 >> (63 - slot_bits);
}

/// The rule by which an adaptive octree chooses split points.
enum class SplitRule : std::uint32_t {
    median = 0,        ///< along each axis, the median midpoint of the triangles' boxes, clipped
                       ///< to the cell; the cell's middle if the median is on its boundary
    surface_area = 1,  ///< along each axis, one of 15 planes: that with the least sum, over both
                       ///< sides, of surface area times triangle count
};

/// The box that an adaptive octree divides, and its settings. Each inner node of this octree has
/// its own split point.
struct AdaptiveOctree {
    Double3 lower;  ///< of the root's closed box, the triangles' bounding box; model units
    Double3 upper;
    std::uint32_t level;      ///< no node is deeper; at most kOctreeBits
    std::uint32_t threshold;  ///< a cell with fewer triangles is not divided
    SplitRule rule;
    std::uint32_t reserved;  ///< zero
};

/// A cell that some triangle touches: a closed box. The root's box is that of AdaptiveOctree. The
/// planes through `split` divide a node's box into its children's boxes. Children are numbered as
/// in OctreeNode. Nodes are stored level by level, root first, siblings side by side. The
/// references of the leaves are in the order of the nodes.
struct AdaptiveOctreeNode {
    /// The split point, model units. Along each axis it is strictly inside the node's box or at its
    /// upper bound. At the upper bound, the axis is not divided and no child lies above it. An axis
    /// along which the box is flat cannot be divided. At least one axis is divided. For a leaf:
    /// zero.
    Double3 split;
    std::uint32_t first;  ///< as in OctreeNode
    std::uint32_t count;  ///< as in OctreeNode
};

/// The box around the contents of a cell, in frame coordinates, rounded outwards. A leaf's box
/// bounds the intersections of its cell with the box of each of its triangles. An inner node's box
/// bounds its children's boxes. So any part of a triangle in a cell also lies in the cell's box.
/// The box is often much smaller than the cell.
struct CellBox {
    std::array<float, 3> lower;
    std::array<float, 3> upper;
};

static_assert(sizeof(CellBox) == 24 && alignof(CellBox) == 4);
static_assert(sizeof(OctreeGrid) == 48 && alignof(OctreeGrid) == 8);
static_assert(offsetof(OctreeGrid, level) == 32);
static_assert(sizeof(OctreeNode) == 16 && alignof(OctreeNode) == 8);
static_assert(offsetof(OctreeNode, first) == 8 && offsetof(OctreeNode, count) == 12);
static_assert(sizeof(AdaptiveOctree) == 64 && alignof(AdaptiveOctree) == 8);
static_assert(offsetof(AdaptiveOctree, level) == 48);
static_assert(sizeof(AdaptiveOctreeNode) == 32 && alignof(AdaptiveOctreeNode) == 8);
static_assert(offsetof(AdaptiveOctreeNode, first) == 24);
static_assert(std::is_trivially_copyable_v<OctreeGrid> &&
              std::is_trivially_copyable_v<OctreeNode> &&
              std::is_trivially_copyable_v<AdaptiveOctree> &&
              std::is_trivially_copyable_v<AdaptiveOctreeNode>);

}  // namespace cdprep::format
