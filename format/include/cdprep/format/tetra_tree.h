// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"

namespace cdprep::format {

/// Levels of splits that a 32-bit key holds: four bits for the octant, two a split.
inline constexpr std::uint32_t kMaxTetraLevel = 14;

/// Number of splits above a cone, of its key, which is 8 at least: else 0.
[[nodiscard]] constexpr std::uint32_t tetra_level(std::uint32_t key) noexcept {
    return (static_cast<std::uint32_t>(std::bit_width(key | 8)) - 4) / 2;
}

/// Cones of a level, whose keys are this and what follows, as many.
[[nodiscard]] constexpr std::uint32_t tetra_cones(std::uint32_t level) noexcept {
    return 8U << (2 * level);
}

/// What bounds a cone's triangles along its octant's axis.
enum class TetraBounding : std::uint32_t {
    tetra = 0,  ///< from the centre to the farthest: the paper's tetrahedra, radius_min is 0
    caps = 1,   ///< from the nearest to the farthest: hollow middles prune
    boxes = 2,  ///< as caps, and boxes: sections tetra_boxes and tetra_oriented
};

/// Bits of TetraTree::flags.
enum TetraTreeFlags : std::uint32_t {
    tetra_centre_inside = 1,  ///< a ray from the centre leaves the surface more often than it
                              ///< enters, or less: of a closed one, the winding number is not 0
    tetra_centre_on = 2,      ///< a triangle holds the centre
};

/// A tetra-tree: eight cones around a centre, one an octant, each split in four.
///
/// The octant's cone has the three half axes as generators; a split puts a new generator
/// in the middle of each two, on the flat face |x| + |y| + |z| = 1 of the octahedron, and
/// makes children (v1, m12, m31), (m12, v2, m23), (m31, m23, v3) and (m12, m23, m31).
/// Generators of level l are integers divided by 2^l, so membership is exact.
struct TetraTree {
    Double3 centre;           ///< C: the mean of the vertices, model units
    std::uint32_t level;      ///< no cone has more splits above it; at most kMaxTetraLevel
    std::uint32_t threshold;  ///< a cone with fewer triangles is not split
    std::uint32_t top_level;  ///< of tetra_top; at most `level`
    TetraBounding bounding;
    /// The first so many of tetra_references hold the centre: they touch every cone and
    /// are listed in none.
    std::uint32_t centre_count;
    std::uint32_t flags;  ///< TetraTreeFlags
};

/// Bits of TetraNode::flags.
enum TetraNodeFlags : std::uint32_t {
    tetra_children = 0xf,  ///< mask: which of the four children are there
    tetra_inner = 0x10,    ///< has children; without it a leaf
};

/// One cone that some triangle touches. Nodes are sorted by `key`: level by level;
/// the octants, keys 8 to 15, come first.
struct TetraNode {
    /// 8 + octant, then two bits a split. Bit 0 of the octant is set where x is
    /// negative, bit 1 y, bit 2 z. Parent: key >> 2.
    std::uint32_t key;
    std::uint32_t first;  ///< leaf: its first reference; inner node: its first child
    std::uint32_t count;  ///< leaf: references; inner node: children
    /// Least and greatest n . (x - C) of the part of the triangles in the closed cone, n
    /// the unit vector (+-1, +-1, +-1) / sqrt(3) of the octant; frame units
    /// (2^FileHeader::frame_exponent), rounded outwards. radius_min is 0 with
    /// TetraBounding::tetra.
    float radius_min;
    float radius_max;
    std::uint32_t flags;  ///< TetraNodeFlags
};

/// With TetraBounding::boxes, lane k of element i of tetra_boxes (BvhNode) and of
/// tetra_oriented (OrientedNode) are boxes of node kTetraBoxStride * i + k: both hold the part
/// of the triangles below that lies in the closed cone, as those elements hold vertices
/// (geometry.h). An inner node's aligned box is the one around its children's. So four
/// children or fewer stand side by side in the element that their first one's number divided
/// by the stride gives, wherever they begin, and octants in element 0; each box is there
/// twice. Lanes past the last node are unused ones.
inline constexpr std::uint32_t kTetraBoxStride = 4;

/// Elements of each section for so many nodes.
[[nodiscard]] constexpr std::uint64_t tetra_box_count(std::uint64_t nodes) noexcept {
    return (nodes + kTetraBoxStride - 1) / kTetraBoxStride;
}

static_assert(sizeof(TetraTree) == 48 && alignof(TetraTree) == 8);
static_assert(offsetof(TetraTree, level) == 24 && offsetof(TetraTree, flags) == 44);
static_assert(sizeof(TetraNode) == 24 && alignof(TetraNode) == 4);
static_assert(offsetof(TetraNode, radius_min) == 12 && offsetof(TetraNode, flags) == 20);
static_assert(std::is_trivially_copyable_v<TetraTree> && std::is_trivially_copyable_v<TetraNode>);

}  // namespace cdprep::format
