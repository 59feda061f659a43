// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"

namespace cdprep::format {

/// The largest number of split levels that a 32-bit key holds: four bits for the octant, two per
/// split.
inline constexpr std::uint32_t kMaxTetraLevel = 14;

/// Returns the number of splits above the cone with this key. Keys are at least 8; smaller values
/// give 0.
[[nodiscard]] constexpr std::uint32_t tetra_level(std::uint32_t key) noexcept {
    return (static_cast<std::uint32_t>(std::bit_width(key | 8)) - 4) / 2;
}

/// Returns the number of cones of a level. The keys of these cones are consecutive and begin with
/// this number.
[[nodiscard]] constexpr std::uint32_t tetra_cones(std::uint32_t level) noexcept {
    return 8U << (2 * level);
}

/// The bounds of the triangles in a cone of a tetra-tree: their extent along the diagonal of the
/// cone's octant.
enum class TetraBounding : std::uint32_t {
    tetra = 0,  ///< from the centre to the farthest point: tetrahedra as published; radius_min is 0
    caps = 1,   ///< from the nearest to the farthest point: prunes the empty space at the centre
    boxes = 2,  ///< as caps, with boxes in sections tetra_boxes and tetra_oriented
};

/// Bits of TetraTree::flags.
enum TetraTreeFlags : std::uint32_t {
    tetra_centre_inside = 1,  ///< a ray from the centre crosses the surface more often in one
                              ///< direction (inwards or outwards) than in the other. If the mesh
                              ///< is balanced, the winding number at the centre is then not 0.
                              ///< Not set together with tetra_centre_on
    tetra_centre_on = 2,      ///< a triangle contains the centre
};

/// A tetra-tree: eight cones around a centre, one per octant, each split in four.
///
/// The generators of an octant's cone are its three half axes v1, v2 and v3. A split adds the
/// midpoints m12, m23 and m31 of the pairs of generators. The midpoints lie on a flat face of the
/// octahedron |x| + |y| + |z| = 1. The split makes the children
///
///     (v1, m12, m31), (m12, v2, m23), (m31, m23, v3) and (m12, m23, m31).
///
/// On level l, the coordinates of generators are integers divided by 2^l. So the test whether a
/// cone contains a point is exact.
struct TetraTree {
    Double3 centre;           ///< C: the mean of the triangles' vertices, rounded; model units
    std::uint32_t level;      ///< no cone is deeper; at most kMaxTetraLevel
    std::uint32_t threshold;  ///< a cone with fewer triangles is not split
    std::uint32_t top_level;  ///< the level of the cones in tetra_top; at most `level`
    TetraBounding bounding;
    /// The number of triangles that contain the centre. Their references come first in
    /// tetra_references. These triangles touch every cone, and no leaf lists them.
    std::uint32_t centre_count;
    std::uint32_t flags;  ///< TetraTreeFlags
};

/// Bits of TetraNode::flags.
enum TetraNodeFlags : std::uint32_t {
    tetra_children = 0xf,  ///< mask: bit i is set if child i exists
    tetra_inner = 0x10,    ///< has children; a leaf lacks this bit
};

/// A cone that some triangle touches; triangles that contain the centre do not count. Nodes are
/// sorted by `key` and so stored level by level. The octants, keys 8 to 15, come first.
struct TetraNode {
    /// 8 + octant, then two bits per split. Bits 0, 1 and 2 of the octant stand for x, y and z. A
    /// bit is set if that coordinate is negative. The parent is key >> 2.
    std::uint32_t key;
    std::uint32_t first;  ///< leaf: its first reference; inner node: its first child
    std::uint32_t count;  ///< leaf: references; inner node: children
    /// The least and greatest distance n . (x - C) from the centre C along n. x ranges over the
    /// points of the triangles in the closed cone, without those triangles that contain C. n is the
    /// octant's (+-1, +-1, +-1) / sqrt(3). Frame units (model units *
    /// 2^FileHeader::frame_exponent), rounded outwards. radius_min is 0 with TetraBounding::tetra.
    float radius_min;
    float radius_max;
    std::uint32_t flags;  ///< TetraNodeFlags
};

/// The stride of tetra_boxes and tetra_oriented: consecutive elements start this many nodes apart.
///
/// With TetraBounding::boxes, both sections hold boxes of nodes: tetra_boxes in a BvhNode,
/// tetra_oriented in an OrientedNode. Lane k of element i belongs to node kTetraBoxStride * i + k.
/// Both boxes contain the part of the triangles below that lies in the closed cone. Both are as
/// exact as the boxes in geometry.h. An inner node's aligned box is the box around its children's
/// aligned boxes.
///
/// The boxes of nodes 0 to 3 are stored once, all others twice. So the boxes of up to four children
/// lie side by side in one element, wherever the children begin. The index of that element is the
/// first child's index divided by the stride, rounded down. The boxes of octants lie in element 0.
/// Lanes past the last node hold unused boxes.
inline constexpr std::uint32_t kTetraBoxStride = 4;

/// Returns the number of elements of tetra_boxes, and of tetra_oriented, for `nodes` nodes.
[[nodiscard]] constexpr std::uint64_t tetra_box_count(std::uint64_t nodes) noexcept {
    return (nodes + kTetraBoxStride - 1) / kTetraBoxStride;
}

static_assert(sizeof(TetraTree) == 48 && alignof(TetraTree) == 8);
static_assert(offsetof(TetraTree, level) == 24 && offsetof(TetraTree, flags) == 44);
static_assert(sizeof(TetraNode) == 24 && alignof(TetraNode) == 4);
static_assert(offsetof(TetraNode, radius_min) == 12 && offsetof(TetraNode, flags) == 20);
static_assert(std::is_trivially_copyable_v<TetraTree> && std::is_trivially_copyable_v<TetraNode>);

}  // namespace cdprep::format
