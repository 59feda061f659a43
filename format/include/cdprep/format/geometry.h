// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/limits.h"

namespace cdprep::format {

/// A point or vector in single precision.
struct Float3 {
    float x, y, z;
    friend bool operator==(const Float3&, const Float3&) = default;
};

/// A point or vector in double precision.
struct Double3 {
    double x, y, z;
    friend bool operator==(const Double3&, const Double3&) = default;
};

/// Three vertex numbers, counter-clockwise seen from outside.
struct Triangle {
    std::array<std::uint32_t, 3> vertex;
    friend bool operator==(const Triangle&, const Triangle&) = default;
};

/// Eight boxes side by side, ready for eight SIMD lanes: row = axis, column = box.
///
/// Box j of node i of level 0 contains leaf 8i + j. Leaf k has up to eight triangles from 8k on, in
/// tree order. Box j of node i of level l > 0 contains node 8i + j of level l - 1. So there are no
/// child links. The triangle count alone fixes the shape (bvh_shape.h), and no file can contain a
/// cycle. Nodes are stored level by level, root first. Box j is unused if there is no leaf or node
/// 8i + j below. Unused boxes have lower = 1, upper = -1.
///
/// Coordinates are frame coordinates, (x - frame_origin) * 2^frame_exponent (FileHeader), rounded
/// outwards. Every vertex of every triangle below lies in the box in exact arithmetic. So a reader
/// needs no tolerance of its own for pruning.
struct BvhNode {
    std::array<std::array<float, kBvhWidth>, 3> lower;  ///< [axis][box], frame coordinates
    std::array<std::array<float, kBvhWidth>, 3> upper;  ///< [axis][box], frame coordinates
};

/// Eight oriented boxes side by side: row = component, column = box. Box j has the same contents as
/// box j of the BvhNode with the same number.
///
/// A box is the set of points centre + sum of t_k axis_k with |t_k| <= half_k. The third axis is
/// the cross product of axis[0] and axis[1]. Axis 0 is the one along which the surface spreads
/// least (least second moment). Axes are orthonormal up to float rounding. The half extents are
/// enlarged so that the box contains every vertex below. This holds for the stored axes and for any
/// rounding of the third axis. Centres and half extents are in frame coordinates. Unused boxes have
/// centre 0, axes along x and y, and half extents of -1.
struct OrientedNode {
    std::array<std::array<std::array<float, kBvhWidth>, 3>, 2> axis;  ///< [axis][component][box]
    std::array<std::array<float, kBvhWidth>, 3> centre;               ///< [component][box]
    std::array<std::array<float, kBvhWidth>, 3> half;                 ///< [axis][box]
};

/// The core of a swept sphere, over which the sphere is swept: a point, a line or a rectangle. A
/// file has one kind only (swept_kind() in file_header.h).
enum class SweptKind : std::uint32_t { point = 0, line = 1, rectangle = 2 };

/// One direction in which the spheres of a SweptNode are swept.
struct SweptSide {
    std::array<std::array<float, kBvhWidth>, 3> axis;  ///< [component][box], unit length
    std::array<float, kBvhWidth> half;                 ///< half the extent along the axis, >= 0
};

/// Eight swept spheres side by side: row = component, column = box. Swept sphere j has the same
/// contents as box j of the BvhNode with the same number.
///
/// A swept sphere contains the points that are at most `radius` from its core. The core is the set
/// of points centre + t_0 axis_0 + t_1 axis_1 with |t_k| <= half_k. For a point, half_0 and half_1
/// are 0; for a line, half_1 is 0. If the cores are points, a reader needs only the first 128 bytes
/// of a node. If they are lines, it needs the first 256. Axes are orthonormal up to float rounding.
/// Axis 0 is the one along which the surface spreads most (greatest second moment). With the axes
/// as stored, a swept sphere contains every vertex below in exact arithmetic. Centres, half extents
/// and radii are in frame coordinates. Unused swept spheres have centre 0, axes along x and y, half
/// extents of 0 and radius 0.
struct SweptNode {
    std::array<std::array<float, kBvhWidth>, 3> centre;  ///< [component][box]
    std::array<float, kBvhWidth> radius;                 ///< >= 0
    std::array<SweptSide, 2> side;
};

/// The corners of the eight triangles of one leaf, ready for eight lanes.
///
/// With model_exact_leaves (FileHeader), corners and origin are in model coordinates. The corners
/// are then the vertices' coordinates without loss. Otherwise the origin is in frame coordinates,
/// and `corner` is the frame coordinate minus the origin, rounded to float. Lanes past the last
/// triangle repeat it.
struct BvhLeaf {
    std::array<std::array<std::array<float, kBvhWidth>, 3>, 3> corner;  ///< [corner][axis][lane]
    std::array<float, 3> origin;                                        ///< near the leaf's middle
    std::array<float, 3> half;  ///< >= distance of corners from origin, by axis; frame units
    std::uint32_t count;        ///< triangles, 1 to 8
    std::uint32_t reserved;     ///< zero
};

/// The two boxes around the whole model, in double precision and model units. Both contain every
/// vertex. The aligned box is exact; the extents of the oriented box are rounded outwards.
struct Bounds {
    Double3 lower;                ///< least coordinates of all vertices
    Double3 upper;                ///< greatest coordinates of all vertices
    Double3 oriented_centre;      ///< of the oriented box
    std::array<Double3, 3> axis;  ///< unit vectors of the oriented box, right-handed
    Double3 half_extent;          ///< of the oriented box along each axis, >= 0
};

/// A maximal set of triangles connected through shared vertices.
///
/// Components are ordered by their lowest triangle number in the source. If two surfaces do not
/// touch, each component lies wholly inside or wholly outside the other model. One vertex of the
/// component then decides which.
struct Component {
    std::uint32_t vertex;          ///< one of its vertices
    std::uint32_t triangle_count;  ///< its triangles
    std::uint32_t flags;           ///< ComponentFlags
    std::uint32_t reserved;        ///< zero
    double signed_volume;          ///< cubic model units; negative if inverted; 0 unless balanced
};

/// Bits of Component::flags.
enum ComponentFlags : std::uint32_t {
    component_balanced = 1,  ///< the directed uses of every edge cancel
};

/// Integrals over the volume of a balanced model of density one, and the area of its surface.
struct MassProperties {
    double volume;        ///< cubic model units, signed
    double surface_area;  ///< square model units
    Double3 centre;       ///< of mass, model units
    /// The inertia tensor about the centre, along the model's axes: xx, yy, zz, xy, yz, zx. Entry
    /// xy is -integral(x y); yz and zx have the same sign convention.
    std::array<double, 6> inertia;
};

/// A use of one mesh by one node of the imported scene.
///
/// Its triangles are a run of source numbers, from first_triangle on. Runs are consecutive, without
/// gaps, and cover all triangles. Instances with equal `mesh` numbers use one mesh. Triangles that
/// a repair added form the last instance, with a `mesh` number of its own.
struct Instance {
    std::array<double, 12> model_from_node;  ///< 3 x 4, row by row; already applied to positions
    std::uint32_t mesh;                      ///< number of the mesh in the imported file
    std::uint32_t name;                      ///< index of the node's path in instance_names
    std::uint32_t first_triangle;            ///< source numbering
    std::uint32_t triangle_count;
    std::uint32_t flags;     ///< InstanceFlags
    std::uint32_t reserved;  ///< zero
};

/// Bits of Instance::flags.
enum InstanceFlags : std::uint32_t {
    instance_mirrored = 1,  ///< the transform mirrors; the winding was reversed to face outwards
};

/// A run of source triangles that share one name (a group or a material). Runs are sorted, do not
/// overlap, and cover all triangles.
struct NamedRun {
    std::uint32_t first_triangle;  ///< source numbering
    std::uint32_t triangle_count;
    std::uint32_t name;      ///< index in group_names or material_names
    std::uint32_t reserved;  ///< zero
};

static_assert(sizeof(Float3) == 12 && alignof(Float3) == 4);
static_assert(sizeof(Double3) == 24 && alignof(Double3) == 8);
static_assert(sizeof(Triangle) == 12 && alignof(Triangle) == 4);
static_assert(sizeof(BvhNode) == 192 && alignof(BvhNode) == 4);
static_assert(offsetof(BvhNode, upper) == 96);
static_assert(sizeof(OrientedNode) == 384 && alignof(OrientedNode) == 4);
static_assert(offsetof(OrientedNode, centre) == 192);
static_assert(sizeof(SweptSide) == 128 && alignof(SweptSide) == 4);
static_assert(sizeof(SweptNode) == 384 && alignof(SweptNode) == 4);
static_assert(offsetof(SweptNode, radius) == 96);
static_assert(offsetof(SweptNode, side) == 128);
static_assert(sizeof(BvhLeaf) == 320 && alignof(BvhLeaf) == 4);
static_assert(offsetof(BvhLeaf, origin) == 288);
static_assert(offsetof(BvhLeaf, count) == 312);
static_assert(sizeof(Bounds) == 168 && alignof(Bounds) == 8);
static_assert(offsetof(Bounds, oriented_centre) == 48);
static_assert(offsetof(Bounds, half_extent) == 144);
static_assert(sizeof(Component) == 24 && alignof(Component) == 8);
static_assert(offsetof(Component, signed_volume) == 16);
static_assert(sizeof(MassProperties) == 88 && alignof(MassProperties) == 8);
static_assert(offsetof(MassProperties, inertia) == 40);
static_assert(sizeof(Instance) == 120 && alignof(Instance) == 8);
static_assert(offsetof(Instance, mesh) == 96);
static_assert(sizeof(NamedRun) == 16 && alignof(NamedRun) == 4);
static_assert(std::is_trivially_copyable_v<BvhNode> && std::is_standard_layout_v<BvhNode>);
static_assert(std::is_trivially_copyable_v<OrientedNode> &&
              std::is_standard_layout_v<OrientedNode>);
static_assert(std::is_trivially_copyable_v<SweptNode> && std::is_standard_layout_v<SweptNode>);
static_assert(std::is_trivially_copyable_v<BvhLeaf> && std::is_standard_layout_v<BvhLeaf>);
static_assert(std::is_trivially_copyable_v<Instance> && std::is_standard_layout_v<Instance>);
static_assert(std::is_trivially_copyable_v<Bounds> && std::is_standard_layout_v<Bounds>);

}  // namespace cdprep::format
