// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"

namespace cdprep::format {

/// Steps along an edge of an octree's cube: 2^21, so that a key of 21 levels, three
/// bits each behind a leading one, fills 64 bits.
inline constexpr std::uint32_t kOctreeBits = 21;

/// Bit of a reference to a triangle that other leaves of the same tree list too. The
/// other bits are the triangle's place in tree order.
inline constexpr std::uint32_t kSharedReference = 0x80000000U;

/// Bit of OctreeNode::count, AdaptiveOctreeNode::count: the node has children, and the
/// low eight bits say which. Without it: a leaf, with that many references.
inline constexpr std::uint32_t kInnerNode = 0x80000000U;

/// By which octree_mixed_table multiplies keys: 2^64 divided by the golden ratio, odd.
inline constexpr std::uint64_t kKeyMixer = 0x9e3779b97f4a7c15U;

/// The cube that an octree divides, and how far it does.
///
/// Plane i of an axis, 0 <= i <= 2^21, lies at origin + i * step: the product is exact
/// (step has at most 32 significant bits), the sum is rounded to double once, and
/// planes of rising number rise strictly. A cell of level l is the closed box between
/// two planes 2^(21 - l) apart along each axis; the root, level 0, holds every vertex
/// and more than a step beyond. So cells of every level are exact, whatever the model's size.
struct OctreeGrid {
    Double3 origin;           ///< model units
    double step;              ///< model units, > 0
    std::uint32_t level;      ///< no node is deeper; at most kOctreeBits
    std::uint32_t threshold;  ///< a cell with fewer triangles is not divided
    std::uint32_t top_level;  ///< of octree_top; at most `level`
    std::uint32_t slot_bits;  ///< 2^slot_bits slots in either hash table
};

/// One cell that some triangle touches. Nodes are sorted by `key`: level by level, and
/// along the z curve within a level; the root, key 1, is first. A model without
/// triangles has none.
struct OctreeNode {
    /// A leading one, then three bits a level from the root down: bit 0 is set in the
    /// upper half along x, bit 1 along y, bit 2 along z. Parent: key >> 3.
    std::uint64_t key;
    /// Leaf: its first reference. Inner node: its first child; the children that are
    /// there follow each other in the order of their last three key bits.
    std::uint32_t first;
    std::uint32_t count;  ///< kInnerNode | mask of children, or number of references
};

/// Level of a key with a leading one; 0 of 0, which is no key.
constexpr std::uint32_t level_of(std::uint64_t key) noexcept {
    return static_cast<std::uint32_t>(std::bit_width(key | 1) - 1) / 3;
}

/// A key without its leading one, shifted up to kOctreeBits levels: where the cell's
/// first finest cell stands along the z curve.
constexpr std::uint64_t code_of(std::uint64_t key) noexcept {
    const std::uint32_t level = level_of(key);
    const std::uint64_t path = key ^ (std::uint64_t{1} << (3 * level));
    return path << (3 * (kOctreeBits - level));
}

/// Finest cells below a cell of a level.
constexpr std::uint64_t cells_below(std::uint32_t level) noexcept {
    return std::uint64_t{1} << (3 * (kOctreeBits - level));
}

/// The slot of a key in octree_modulus_table and in octree_mixed_table.
constexpr std::uint64_t modulus_slot(std::uint64_t key, std::uint32_t slot_bits) noexcept {
    return key & ((std::uint64_t{1} << slot_bits) - 1);
}
constexpr std::uint64_t mixed_slot(std::uint64_t key, std::uint32_t slot_bits) noexcept {
    // In two steps: there may be one slot only, and no shift by 64.
    return (key * kKeyMixer) >> 1 >> (63 - slot_bits);
}

/// How an adaptive octree chooses the point at which a node is split.
enum class SplitRule : std::uint32_t {
    median = 0,        ///< the median of the triangles' middles along each axis
    surface_area = 1,  ///< along each axis the plane of least area times triangles, of 16
};

/// An octree whose nodes choose their split points: the box that it divides, and how.
struct AdaptiveOctree {
    Double3 lower;  ///< of the root's closed box, model units: the model's own box
    Double3 upper;
    std::uint32_t level;      ///< no node is deeper; at most kOctreeBits
    std::uint32_t threshold;  ///< a cell with fewer triangles is not divided
    SplitRule rule;
    std::uint32_t reserved;  ///< zero
};

/// One cell that some triangle touches, a closed box: the root's is AdaptiveOctree's;
/// the planes through `split` divide a node's box into those of its children, numbered
/// as OctreeNode's. Nodes are stored level by level, root first, siblings side by side;
/// leaves' references follow each other in the order of the nodes.
struct AdaptiveOctreeNode {
    /// Along each axis strictly inside the node's box, model units; or its upper bound: then
    /// the axis is not divided, as a flat one cannot be, and no child lies above it. At
    /// least one axis is divided. Of a leaf: zero.
    Double3 split;
    std::uint32_t first;  ///< as OctreeNode
    std::uint32_t count;  ///< as OctreeNode
};

/// Around what a cell holds, frame coordinates, rounded outwards. A leaf's: around what each
/// of its triangles' boxes has in common with the leaf's cell. An inner node's: around its
/// children's. So what of a triangle lies in a cell lies in the cell's box, which is often
/// much smaller than the cell.
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
