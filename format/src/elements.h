// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "cdprep/format/elements.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/hulls.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/format/verdict.h"

namespace cdprep::format {

using enum Scalar;

inline constexpr std::array<Field, 2> kBvhNodeFields = {{
    {"lower", offsetof(BvhNode, lower), f32, {3, kBvhWidth}},
    {"upper", offsetof(BvhNode, upper), f32, {3, kBvhWidth}},
}};

inline constexpr std::array<Field, 3> kOrientedNodeFields = {{
    {"axis", offsetof(OrientedNode, axis), f32, {2, 3, kBvhWidth}},
    {"centre", offsetof(OrientedNode, centre), f32, {3, kBvhWidth}},
    {"half", offsetof(OrientedNode, half), f32, {3, kBvhWidth}},
}};

inline constexpr std::array<Field, 6> kSweptNodeFields = {{
    {"centre", offsetof(SweptNode, centre), f32, {3, kBvhWidth}},
    {"radius", offsetof(SweptNode, radius), f32, {kBvhWidth}},
    {"axis0", offsetof(SweptNode, side), f32, {3, kBvhWidth}},
    {"half0", offsetof(SweptNode, side) + offsetof(SweptSide, half), f32, {kBvhWidth}},
    {"axis1", offsetof(SweptNode, side) + sizeof(SweptSide), f32, {3, kBvhWidth}},
    {"half1",
     offsetof(SweptNode, side) + sizeof(SweptSide) + offsetof(SweptSide, half),
     f32,
     {kBvhWidth}},
}};

inline constexpr std::array<Field, 5> kBvhLeafFields = {{
    {"corner", offsetof(BvhLeaf, corner), f32, {3, 3, kBvhWidth}},
    {"origin", offsetof(BvhLeaf, origin), f32, {3}},
    {"half", offsetof(BvhLeaf, half), f32, {3}},
    {"count", offsetof(BvhLeaf, count), u32},
    {"reserved", offsetof(BvhLeaf, reserved), u32},
}};

inline constexpr std::array<Field, 5> kComponentFields = {{
    {"vertex", offsetof(Component, vertex), u32},
    {"triangle_count", offsetof(Component, triangle_count), u32},
    {"flags", offsetof(Component, flags), u32},
    {"reserved", offsetof(Component, reserved), u32},
    {"signed_volume", offsetof(Component, signed_volume), f64},
}};

inline constexpr std::array<Field, 10> kVerdictFields = {{
    {"facts", offsetof(Verdict, facts), u32},
    {"promises", offsetof(Verdict, promises), u32},
    {"triangle_count", offsetof(Verdict, triangle_count), u32},
    {"first_triangle", offsetof(Verdict, first_triangle), u32},
    {"boundary_loops", offsetof(Verdict, boundary_loops), u32},
    {"euler", offsetof(Verdict, euler), i32},
    {"genus", offsetof(Verdict, genus), i32},
    {"reserved", offsetof(Verdict, reserved), u32},
    {"area", offsetof(Verdict, area), f64},
    {"volume", offsetof(Verdict, volume), f64},
}};

inline constexpr std::array<Field, 5> kBoundsFields = {{
    {"lower", offsetof(Bounds, lower), f64, {3}},
    {"upper", offsetof(Bounds, upper), f64, {3}},
    {"oriented_centre", offsetof(Bounds, oriented_centre), f64, {3}},
    {"axis", offsetof(Bounds, axis), f64, {3, 3}},
    {"half_extent", offsetof(Bounds, half_extent), f64, {3}},
}};

inline constexpr std::array<Field, 4> kMassPropertiesFields = {{
    {"volume", offsetof(MassProperties, volume), f64},
    {"surface_area", offsetof(MassProperties, surface_area), f64},
    {"centre", offsetof(MassProperties, centre), f64, {3}},
    {"inertia", offsetof(MassProperties, inertia), f64, {6}},
}};

inline constexpr std::array<Field, 7> kInstanceFields = {{
    {"model_from_node", offsetof(Instance, model_from_node), f64, {3, 4}},
    {"mesh", offsetof(Instance, mesh), u32},
    {"name", offsetof(Instance, name), u32},
    {"first_triangle", offsetof(Instance, first_triangle), u32},
    {"triangle_count", offsetof(Instance, triangle_count), u32},
    {"flags", offsetof(Instance, flags), u32},
    {"reserved", offsetof(Instance, reserved), u32},
}};

inline constexpr std::array<Field, 6> kOctreeGridFields = {{
    {"origin", offsetof(OctreeGrid, origin), f64, {3}},
    {"step", offsetof(OctreeGrid, step), f64},
    {"level", offsetof(OctreeGrid, level), u32},
    {"threshold", offsetof(OctreeGrid, threshold), u32},
    {"top_level", offsetof(OctreeGrid, top_level), u32},
    {"slot_bits", offsetof(OctreeGrid, slot_bits), u32},
}};

inline constexpr std::array<Field, 3> kOctreeNodeFields = {{
    {"key", offsetof(OctreeNode, key), u64},
    {"first", offsetof(OctreeNode, first), u32},
    {"count", offsetof(OctreeNode, count), u32},
}};

inline constexpr std::array<Field, 4> kNamedRunFields = {{
    {"first_triangle", offsetof(NamedRun, first_triangle), u32},
    {"triangle_count", offsetof(NamedRun, triangle_count), u32},
    {"name", offsetof(NamedRun, name), u32},
    {"reserved", offsetof(NamedRun, reserved), u32},
}};

inline constexpr std::array<Field, 6> kAdaptiveOctreeFields = {{
    {"lower", offsetof(AdaptiveOctree, lower), f64, {3}},
    {"upper", offsetof(AdaptiveOctree, upper), f64, {3}},
    {"level", offsetof(AdaptiveOctree, level), u32},
    {"threshold", offsetof(AdaptiveOctree, threshold), u32},
    {"rule", offsetof(AdaptiveOctree, rule), u32},
    {"reserved", offsetof(AdaptiveOctree, reserved), u32},
}};

inline constexpr std::array<Field, 3> kAdaptiveOctreeNodeFields = {{
    {"split", offsetof(AdaptiveOctreeNode, split), f64, {3}},
    {"first", offsetof(AdaptiveOctreeNode, first), u32},
    {"count", offsetof(AdaptiveOctreeNode, count), u32},
}};

inline constexpr std::array<Field, 2> kCellBoxFields = {{
    {"lower", offsetof(CellBox, lower), f32, {3}},
    {"upper", offsetof(CellBox, upper), f32, {3}},
}};

inline constexpr std::array<Field, 7> kTetraTreeFields = {{
    {"centre", offsetof(TetraTree, centre), f64, {3}},
    {"level", offsetof(TetraTree, level), u32},
    {"threshold", offsetof(TetraTree, threshold), u32},
    {"top_level", offsetof(TetraTree, top_level), u32},
    {"bounding", offsetof(TetraTree, bounding), u32},
    {"centre_count", offsetof(TetraTree, centre_count), u32},
    {"flags", offsetof(TetraTree, flags), u32},
}};

inline constexpr std::array<Field, 6> kTetraNodeFields = {{
    {"key", offsetof(TetraNode, key), u32},
    {"first", offsetof(TetraNode, first), u32},
    {"count", offsetof(TetraNode, count), u32},
    {"radius_min", offsetof(TetraNode, radius_min), f32},
    {"radius_max", offsetof(TetraNode, radius_max), f32},
    {"flags", offsetof(TetraNode, flags), u32},
}};

inline constexpr std::array<Field, 16> kHullFields = {{
    {"scope", offsetof(Hull, scope), u32},
    {"number", offsetof(Hull, number), u32},
    {"dimension", offsetof(Hull, dimension), i32},
    {"flags", offsetof(Hull, flags), u32},
    {"first_block", offsetof(Hull, first_block), u32},
    {"point_count", offsetof(Hull, point_count), u32},
    {"first_facet", offsetof(Hull, first_facet), u32},
    {"facet_count", offsetof(Hull, facet_count), u32},
    {"first_group", offsetof(Hull, first_group), u32},
    {"group_count", offsetof(Hull, group_count), u32},
    {"first_neighbour", offsetof(Hull, first_neighbour), u32},
    {"neighbour_count", offsetof(Hull, neighbour_count), u32},
    {"first_start", offsetof(Hull, first_start), u32},
    {"start_count", offsetof(Hull, start_count), u32},
    {"distance", offsetof(Hull, distance), f64},
    {"reach", offsetof(Hull, reach), f64, {3}},
}};

inline constexpr std::array<Field, 1> kHullBlockFields = {{
    {"at", offsetof(HullBlock, at), f64, {3, kHullLanes}},
}};

inline constexpr std::array<Field, 3> kHullFacetFields = {{
    {"point", offsetof(HullFacet, point), u32, {3}},
    {"across", offsetof(HullFacet, across), u32, {3}},
    {"group", offsetof(HullFacet, group), u32},
}};

inline constexpr std::array<Field, 2> kHullGroupFields = {{
    {"first_facet", offsetof(HullGroup, first_facet), u32},
    {"facet_count", offsetof(HullGroup, facet_count), u32},
}};

inline constexpr std::array<Field, 7> kPieceFields = {{
    {"first_triangle", offsetof(Piece, first_triangle), u32},
    {"first_vertex", offsetof(Piece, first_vertex), u32},
    {"first_facet", offsetof(Piece, first_facet), u32},
    {"flags", offsetof(Piece, flags), u32},
    {"outer_error", offsetof(Piece, outer_error), f64},
    {"dimension", offsetof(Piece, dimension), u32},
    {"reserved", offsetof(Piece, reserved), u32},
}};

inline constexpr std::array<Field, 2> kPieceFacetFields = {{
    {"corner", offsetof(PieceFacet, corner), u32, {3}},
    {"flags", offsetof(PieceFacet, flags), u32},
}};

inline constexpr std::array<Field, 3> kPieceLeafFields = {{
    {"piece", offsetof(PieceLeaf, piece), u32},
    {"first_triangle", offsetof(PieceLeaf, first_triangle), u32},
    {"count", offsetof(PieceLeaf, count), u32},
}};

inline constexpr std::array<Field, 4> kPieceNodeHullFields = {{
    {"block", offsetof(PieceNodeHull, block), f64, {kPieceHullCorners / kHullLanes, 3, kHullLanes}},
    {"slack", offsetof(PieceNodeHull, slack), f64},
    {"count", offsetof(PieceNodeHull, count), u32},
    {"reserved", offsetof(PieceNodeHull, reserved), u32, {13}},
}};

inline constexpr std::array<Field, 1> kPieceAdjacencyFields = {{
    {"across", offsetof(PieceAdjacency, across), u32, {3}},
}};

template <class T, std::size_t N>
constexpr Element compound(const char* name, const std::array<Field, N>& fields) noexcept {
    return {name, sizeof(T), u8, 1, fields};
}

template <class T>
constexpr Element no_layout() noexcept = delete;

/// The layout of an element type of the section table. A type without a layout does not compile.
template <class T>
inline constexpr Element element_of = no_layout<T>();

template <>
inline constexpr Element element_of<Text> = {"u8", 1, u8, 1, {}};
template <>
inline constexpr Element element_of<std::uint8_t> = {"u8", sizeof(std::uint8_t), u8, 1, {}};
template <>
inline constexpr Element element_of<std::uint32_t> = {"u32", sizeof(std::uint32_t), u32, 1, {}};
template <>
inline constexpr Element element_of<std::uint64_t> = {"u64", sizeof(std::uint64_t), u64, 1, {}};
template <>
inline constexpr Element element_of<Float3> = {"f32 x, y, z", sizeof(Float3), f32, 3, {}};
template <>
inline constexpr Element element_of<Double3> = {"f64 x, y, z", sizeof(Double3), f64, 3, {}};
template <>
inline constexpr Element element_of<Triangle> = {"u32 x 3", sizeof(Triangle), u32, 3, {}};
template <>
inline constexpr Element element_of<BvhNode> = compound<BvhNode>("BvhNode", kBvhNodeFields);
template <>
inline constexpr Element element_of<OrientedNode> = compound<OrientedNode>("OrientedNode",
                                                                           kOrientedNodeFields);
template <>
inline constexpr Element element_of<SweptNode> = compound<SweptNode>("SweptNode", kSweptNodeFields);
template <>
inline constexpr Element element_of<BvhLeaf> = compound<BvhLeaf>("BvhLeaf", kBvhLeafFields);
template <>
inline constexpr Element element_of<Component> = compound<Component>("Component", kComponentFields);
template <>
inline constexpr Element element_of<Verdict> = compound<Verdict>("Verdict", kVerdictFields);
template <>
inline constexpr Element element_of<Bounds> = compound<Bounds>("Bounds", kBoundsFields);
template <>
inline constexpr Element element_of<MassProperties> =
    compound<MassProperties>("MassProperties", kMassPropertiesFields);
template <>
inline constexpr Element element_of<Instance> = compound<Instance>("Instance", kInstanceFields);
template <>
inline constexpr Element element_of<OctreeGrid> = compound<OctreeGrid>("OctreeGrid",
                                                                       kOctreeGridFields);
template <>
inline constexpr Element element_of<OctreeNode> = compound<OctreeNode>("OctreeNode",
                                                                       kOctreeNodeFields);
template <>
inline constexpr Element element_of<NamedRun> = compound<NamedRun>("NamedRun", kNamedRunFields);
template <>
inline constexpr Element element_of<AdaptiveOctree> =
    compound<AdaptiveOctree>("AdaptiveOctree", kAdaptiveOctreeFields);
template <>
inline constexpr Element element_of<AdaptiveOctreeNode> =
    compound<AdaptiveOctreeNode>("AdaptiveOctreeNode", kAdaptiveOctreeNodeFields);
template <>
inline constexpr Element element_of<CellBox> = compound<CellBox>("CellBox", kCellBoxFields);
template <>
inline constexpr Element element_of<TetraTree> = compound<TetraTree>("TetraTree", kTetraTreeFields);
template <>
inline constexpr Element element_of<TetraNode> = compound<TetraNode>("TetraNode", kTetraNodeFields);
template <>
inline constexpr Element element_of<Hull> = compound<Hull>("Hull", kHullFields);
template <>
inline constexpr Element element_of<HullBlock> = compound<HullBlock>("HullBlock", kHullBlockFields);
template <>
inline constexpr Element element_of<HullFacet> = compound<HullFacet>("HullFacet", kHullFacetFields);
template <>
inline constexpr Element element_of<HullGroup> = compound<HullGroup>("HullGroup", kHullGroupFields);
template <>
inline constexpr Element element_of<Piece> = compound<Piece>("Piece", kPieceFields);
template <>
inline constexpr Element element_of<PieceFacet> = compound<PieceFacet>("PieceFacet",
                                                                       kPieceFacetFields);
template <>
inline constexpr Element element_of<PieceLeaf> = compound<PieceLeaf>("PieceLeaf", kPieceLeafFields);
template <>
inline constexpr Element element_of<PieceNodeHull> = compound<PieceNodeHull>("PieceNodeHull",
                                                                             kPieceNodeHullFields);
template <>
inline constexpr Element element_of<PieceAdjacency> =
    compound<PieceAdjacency>("PieceAdjacency", kPieceAdjacencyFields);

template <class T>
inline constexpr Element element_of<One<T>> = element_of<T>;

}  // namespace cdprep::format
