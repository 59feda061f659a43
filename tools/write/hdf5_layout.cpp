// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/hdf5_layout.h"

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <utility>

#include "cdprep/format/geometry.h"
#include "cdprep/format/hulls.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/sections.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/format/verdict.h"
#include "write/hdf5_in_memory.h"

// HDF5 gives bytes that depend on nothing but the content when time stamps are
// off for the file, its groups and its datasets, and the library version is
// pinned. Alignment belongs to the open, not to the dataset, so large sections
// (on pages) and small ones (on cache lines) are made in two opens.

namespace cdprep::write {
namespace {

using format::SectionId;

constexpr const char* kGroup = "/cdprep";

/// An HDF5 identifier that closes itself.
class Handle {
public:
    Handle(hid_t id, herr_t (*closer)(hid_t)) noexcept : id_(id), close_(closer) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    [[nodiscard]] hid_t id() const noexcept {
        return id_;
    }
    [[nodiscard]] bool good() const noexcept {
        return id_ >= 0;
    }
    /// Closes now and tells whether that worked: HDF5 writes when it closes.
    [[nodiscard]] bool close() noexcept {
        return id_ >= 0 && close_(std::exchange(id_, -1)) >= 0;
    }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Keeps HDF5 from printing while it lives.
class Silence {
public:
    Silence() {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;
    ~Silence() {
        H5Eset_auto2(H5E_DEFAULT, print_, data_);
    }

private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

// --- Element types -----------------------------------------------------------

/// A member of a compound type: an HDF5 scalar, possibly an array of it.
struct Member {
    const char* name;
    std::size_t offset;
    hid_t scalar;
    std::vector<hsize_t> shape;
};

Handle array_of(hid_t scalar, const std::vector<hsize_t>& shape) {
    if (shape.empty()) return {H5Tcopy(scalar), H5Tclose};
    return {H5Tarray_create2(scalar, static_cast<unsigned>(shape.size()), shape.data()), H5Tclose};
}

Handle compound(std::size_t size, const std::vector<Member>& members) {
    Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
    for (const Member& member : members) {
        const Handle element = array_of(member.scalar, member.shape);
        H5Tinsert(type.id(), member.name, member.offset, element.id());
    }
    return type;
}

Handle node_type() {
    using format::BvhNode;
    return compound(sizeof(BvhNode),
                    {{"lower", offsetof(BvhNode, lower), H5T_IEEE_F32LE, {3, format::kBvhWidth}},
                     {"upper", offsetof(BvhNode, upper), H5T_IEEE_F32LE, {3, format::kBvhWidth}}});
}

Handle oriented_type() {
    using format::OrientedNode;
    constexpr hsize_t kWidth = format::kBvhWidth;
    return compound(sizeof(OrientedNode),
                    {{"axis", offsetof(OrientedNode, axis), H5T_IEEE_F32LE, {2, 3, kWidth}},
                     {"centre", offsetof(OrientedNode, centre), H5T_IEEE_F32LE, {3, kWidth}},
                     {"half", offsetof(OrientedNode, half), H5T_IEEE_F32LE, {3, kWidth}}});
}

Handle swept_type() {
    using format::SweptNode;
    using format::SweptSide;
    constexpr hsize_t kWidth = format::kBvhWidth;
    constexpr std::size_t kSide = offsetof(SweptNode, side);
    constexpr std::size_t kHalf = offsetof(SweptSide, half);
    return compound(sizeof(SweptNode),
                    {{"centre", offsetof(SweptNode, centre), H5T_IEEE_F32LE, {3, kWidth}},
                     {"radius", offsetof(SweptNode, radius), H5T_IEEE_F32LE, {kWidth}},
                     {"axis0", kSide, H5T_IEEE_F32LE, {3, kWidth}},
                     {"half0", kSide + kHalf, H5T_IEEE_F32LE, {kWidth}},
                     {"axis1", kSide + sizeof(SweptSide), H5T_IEEE_F32LE, {3, kWidth}},
                     {"half1", kSide + sizeof(SweptSide) + kHalf, H5T_IEEE_F32LE, {kWidth}}});
}

Handle leaf_type() {
    using format::BvhLeaf;
    return compound(
        sizeof(BvhLeaf),
        {{"corner", offsetof(BvhLeaf, corner), H5T_IEEE_F32LE, {3, 3, format::kBvhWidth}},
         {"origin", offsetof(BvhLeaf, origin), H5T_IEEE_F32LE, {3}},
         {"half", offsetof(BvhLeaf, half), H5T_IEEE_F32LE, {3}},
         {"count", offsetof(BvhLeaf, count), H5T_STD_U32LE, {}},
         {"reserved", offsetof(BvhLeaf, reserved), H5T_STD_U32LE, {}}});
}

Handle component_type() {
    using format::Component;
    return compound(sizeof(Component),
                    {{"vertex", offsetof(Component, vertex), H5T_STD_U32LE, {}},
                     {"triangle_count", offsetof(Component, triangle_count), H5T_STD_U32LE, {}},
                     {"flags", offsetof(Component, flags), H5T_STD_U32LE, {}},
                     {"reserved", offsetof(Component, reserved), H5T_STD_U32LE, {}},
                     {"signed_volume", offsetof(Component, signed_volume), H5T_IEEE_F64LE, {}}});
}

Handle verdict_type() {
    using format::Verdict;
    return compound(sizeof(Verdict),
                    {{"facts", offsetof(Verdict, facts), H5T_STD_U32LE, {}},
                     {"promises", offsetof(Verdict, promises), H5T_STD_U32LE, {}},
                     {"triangle_count", offsetof(Verdict, triangle_count), H5T_STD_U32LE, {}},
                     {"first_triangle", offsetof(Verdict, first_triangle), H5T_STD_U32LE, {}},
                     {"boundary_loops", offsetof(Verdict, boundary_loops), H5T_STD_U32LE, {}},
                     {"euler", offsetof(Verdict, euler), H5T_STD_I32LE, {}},
                     {"genus", offsetof(Verdict, genus), H5T_STD_I32LE, {}},
                     {"reserved", offsetof(Verdict, reserved), H5T_STD_U32LE, {}},
                     {"area", offsetof(Verdict, area), H5T_IEEE_F64LE, {}},
                     {"volume", offsetof(Verdict, volume), H5T_IEEE_F64LE, {}}});
}

Handle bounds_type() {
    using format::Bounds;
    return compound(sizeof(Bounds),
                    {{"lower", offsetof(Bounds, lower), H5T_IEEE_F64LE, {3}},
                     {"upper", offsetof(Bounds, upper), H5T_IEEE_F64LE, {3}},
                     {"oriented_centre", offsetof(Bounds, oriented_centre), H5T_IEEE_F64LE, {3}},
                     {"axis", offsetof(Bounds, axis), H5T_IEEE_F64LE, {3, 3}},
                     {"half_extent", offsetof(Bounds, half_extent), H5T_IEEE_F64LE, {3}}});
}

Handle mass_type() {
    using format::MassProperties;
    return compound(sizeof(MassProperties),
                    {{"volume", offsetof(MassProperties, volume), H5T_IEEE_F64LE, {}},
                     {"surface_area", offsetof(MassProperties, surface_area), H5T_IEEE_F64LE, {}},
                     {"centre", offsetof(MassProperties, centre), H5T_IEEE_F64LE, {3}},
                     {"inertia", offsetof(MassProperties, inertia), H5T_IEEE_F64LE, {6}}});
}

Handle instance_type() {
    using format::Instance;
    return compound(
        sizeof(Instance),
        {{"model_from_node", offsetof(Instance, model_from_node), H5T_IEEE_F64LE, {3, 4}},
         {"mesh", offsetof(Instance, mesh), H5T_STD_U32LE, {}},
         {"name", offsetof(Instance, name), H5T_STD_U32LE, {}},
         {"first_triangle", offsetof(Instance, first_triangle), H5T_STD_U32LE, {}},
         {"triangle_count", offsetof(Instance, triangle_count), H5T_STD_U32LE, {}},
         {"flags", offsetof(Instance, flags), H5T_STD_U32LE, {}},
         {"reserved", offsetof(Instance, reserved), H5T_STD_U32LE, {}}});
}

Handle octree_grid_type() {
    using format::OctreeGrid;
    return compound(sizeof(OctreeGrid),
                    {{"origin", offsetof(OctreeGrid, origin), H5T_IEEE_F64LE, {3}},
                     {"step", offsetof(OctreeGrid, step), H5T_IEEE_F64LE, {}},
                     {"level", offsetof(OctreeGrid, level), H5T_STD_U32LE, {}},
                     {"threshold", offsetof(OctreeGrid, threshold), H5T_STD_U32LE, {}},
                     {"top_level", offsetof(OctreeGrid, top_level), H5T_STD_U32LE, {}},
                     {"slot_bits", offsetof(OctreeGrid, slot_bits), H5T_STD_U32LE, {}}});
}

Handle octree_node_type() {
    using format::OctreeNode;
    return compound(sizeof(OctreeNode),
                    {{"key", offsetof(OctreeNode, key), H5T_STD_U64LE, {}},
                     {"first", offsetof(OctreeNode, first), H5T_STD_U32LE, {}},
                     {"count", offsetof(OctreeNode, count), H5T_STD_U32LE, {}}});
}

Handle run_type() {
    using format::NamedRun;
    return compound(sizeof(NamedRun),
                    {{"first_triangle", offsetof(NamedRun, first_triangle), H5T_STD_U32LE, {}},
                     {"triangle_count", offsetof(NamedRun, triangle_count), H5T_STD_U32LE, {}},
                     {"name", offsetof(NamedRun, name), H5T_STD_U32LE, {}},
                     {"reserved", offsetof(NamedRun, reserved), H5T_STD_U32LE, {}}});
}

Handle adaptive_octree_type() {
    using format::AdaptiveOctree;
    return compound(sizeof(AdaptiveOctree),
                    {{"lower", offsetof(AdaptiveOctree, lower), H5T_IEEE_F64LE, {3}},
                     {"upper", offsetof(AdaptiveOctree, upper), H5T_IEEE_F64LE, {3}},
                     {"level", offsetof(AdaptiveOctree, level), H5T_STD_U32LE, {}},
                     {"threshold", offsetof(AdaptiveOctree, threshold), H5T_STD_U32LE, {}},
                     {"rule", offsetof(AdaptiveOctree, rule), H5T_STD_U32LE, {}},
                     {"reserved", offsetof(AdaptiveOctree, reserved), H5T_STD_U32LE, {}}});
}

Handle adaptive_octree_node_type() {
    using format::AdaptiveOctreeNode;
    return compound(sizeof(AdaptiveOctreeNode),
                    {{"split", offsetof(AdaptiveOctreeNode, split), H5T_IEEE_F64LE, {3}},
                     {"first", offsetof(AdaptiveOctreeNode, first), H5T_STD_U32LE, {}},
                     {"count", offsetof(AdaptiveOctreeNode, count), H5T_STD_U32LE, {}}});
}

Handle cell_box_type() {
    using format::CellBox;
    return compound(sizeof(CellBox), {{"lower", offsetof(CellBox, lower), H5T_IEEE_F32LE, {3}},
                                      {"upper", offsetof(CellBox, upper), H5T_IEEE_F32LE, {3}}});
}

Handle tetra_tree_type() {
    using format::TetraTree;
    return compound(sizeof(TetraTree),
                    {{"centre", offsetof(TetraTree, centre), H5T_IEEE_F64LE, {3}},
                     {"level", offsetof(TetraTree, level), H5T_STD_U32LE, {}},
                     {"threshold", offsetof(TetraTree, threshold), H5T_STD_U32LE, {}},
                     {"top_level", offsetof(TetraTree, top_level), H5T_STD_U32LE, {}},
                     {"bounding", offsetof(TetraTree, bounding), H5T_STD_U32LE, {}},
                     {"centre_count", offsetof(TetraTree, centre_count), H5T_STD_U32LE, {}},
                     {"flags", offsetof(TetraTree, flags), H5T_STD_U32LE, {}}});
}

Handle tetra_node_type() {
    using format::TetraNode;
    return compound(sizeof(TetraNode),
                    {{"key", offsetof(TetraNode, key), H5T_STD_U32LE, {}},
                     {"first", offsetof(TetraNode, first), H5T_STD_U32LE, {}},
                     {"count", offsetof(TetraNode, count), H5T_STD_U32LE, {}},
                     {"radius_min", offsetof(TetraNode, radius_min), H5T_IEEE_F32LE, {}},
                     {"radius_max", offsetof(TetraNode, radius_max), H5T_IEEE_F32LE, {}},
                     {"flags", offsetof(TetraNode, flags), H5T_STD_U32LE, {}}});
}

Handle hull_type() {
    using format::Hull;
    return compound(sizeof(Hull),
                    {{"scope", offsetof(Hull, scope), H5T_STD_U32LE, {}},
                     {"number", offsetof(Hull, number), H5T_STD_U32LE, {}},
                     {"dimension", offsetof(Hull, dimension), H5T_STD_I32LE, {}},
                     {"flags", offsetof(Hull, flags), H5T_STD_U32LE, {}},
                     {"first_block", offsetof(Hull, first_block), H5T_STD_U32LE, {}},
                     {"point_count", offsetof(Hull, point_count), H5T_STD_U32LE, {}},
                     {"first_facet", offsetof(Hull, first_facet), H5T_STD_U32LE, {}},
                     {"facet_count", offsetof(Hull, facet_count), H5T_STD_U32LE, {}},
                     {"first_group", offsetof(Hull, first_group), H5T_STD_U32LE, {}},
                     {"group_count", offsetof(Hull, group_count), H5T_STD_U32LE, {}},
                     {"first_neighbour", offsetof(Hull, first_neighbour), H5T_STD_U32LE, {}},
                     {"neighbour_count", offsetof(Hull, neighbour_count), H5T_STD_U32LE, {}},
                     {"first_start", offsetof(Hull, first_start), H5T_STD_U32LE, {}},
                     {"start_count", offsetof(Hull, start_count), H5T_STD_U32LE, {}},
                     {"distance", offsetof(Hull, distance), H5T_IEEE_F64LE, {}},
                     {"reach", offsetof(Hull, reach), H5T_IEEE_F64LE, {3}}});
}

Handle hull_block_type() {
    using format::HullBlock;
    return compound(sizeof(HullBlock),
                    {{"at", offsetof(HullBlock, at), H5T_IEEE_F64LE, {3, format::kHullLanes}}});
}

Handle hull_facet_type() {
    using format::HullFacet;
    return compound(sizeof(HullFacet), {{"point", offsetof(HullFacet, point), H5T_STD_U32LE, {3}},
                                        {"across", offsetof(HullFacet, across), H5T_STD_U32LE, {3}},
                                        {"group", offsetof(HullFacet, group), H5T_STD_U32LE, {}}});
}

Handle hull_group_type() {
    using format::HullGroup;
    return compound(sizeof(HullGroup),
                    {{"first_facet", offsetof(HullGroup, first_facet), H5T_STD_U32LE, {}},
                     {"facet_count", offsetof(HullGroup, facet_count), H5T_STD_U32LE, {}}});
}

Handle piece_type() {
    using format::Piece;
    return compound(sizeof(Piece),
                    {{"first_triangle", offsetof(Piece, first_triangle), H5T_STD_U32LE, {}},
                     {"first_vertex", offsetof(Piece, first_vertex), H5T_STD_U32LE, {}},
                     {"first_facet", offsetof(Piece, first_facet), H5T_STD_U32LE, {}},
                     {"flags", offsetof(Piece, flags), H5T_STD_U32LE, {}},
                     {"outer_error", offsetof(Piece, outer_error), H5T_IEEE_F64LE, {}},
                     {"dimension", offsetof(Piece, dimension), H5T_STD_U32LE, {}},
                     {"reserved", offsetof(Piece, reserved), H5T_STD_U32LE, {}}});
}

Handle piece_facet_type() {
    using format::PieceFacet;
    return compound(sizeof(PieceFacet),
                    {{"corner", offsetof(PieceFacet, corner), H5T_STD_U32LE, {3}},
                     {"flags", offsetof(PieceFacet, flags), H5T_STD_U32LE, {}}});
}

Handle piece_leaf_type() {
    using format::PieceLeaf;
    return compound(sizeof(PieceLeaf),
                    {{"piece", offsetof(PieceLeaf, piece), H5T_STD_U32LE, {}},
                     {"first_triangle", offsetof(PieceLeaf, first_triangle), H5T_STD_U32LE, {}},
                     {"count", offsetof(PieceLeaf, count), H5T_STD_U32LE, {}}});
}

Handle piece_node_hull_type() {
    using format::PieceNodeHull;
    constexpr std::size_t kBlocks = format::kPieceHullCorners / format::kHullLanes;
    return compound(sizeof(PieceNodeHull),
                    {{"block",
                      offsetof(PieceNodeHull, block),
                      H5T_IEEE_F64LE,
                      {kBlocks, 3, format::kHullLanes}},
                     {"slack", offsetof(PieceNodeHull, slack), H5T_IEEE_F64LE, {}},
                     {"count", offsetof(PieceNodeHull, count), H5T_STD_U32LE, {}},
                     {"reserved", offsetof(PieceNodeHull, reserved), H5T_STD_U32LE, {13}}});
}

Handle piece_adjacency_type() {
    using format::PieceAdjacency;
    return compound(sizeof(PieceAdjacency),
                    {{"across", offsetof(PieceAdjacency, across), H5T_STD_U32LE, {3}}});
}

Handle scalar(hid_t type) {
    return {H5Tcopy(type), H5Tclose};
}

/// How a section shows in HDF5.
struct Look {
    SectionId id;
    std::function<Handle()> type;
    unsigned columns;  ///< 0: one-dimensional
    const char* units;
    const char* description;
};

const std::vector<Look>& looks() {
    static const std::vector<Look> all = {
        {SectionId::positions_f32, [] { return scalar(H5T_IEEE_F32LE); }, 3, "model units",
         "x, y, z of each vertex"},
        {SectionId::positions_f64, [] { return scalar(H5T_IEEE_F64LE); }, 3, "model units",
         "x, y, z of each vertex"},
        {SectionId::triangles, [] { return scalar(H5T_STD_U32LE); }, 3, "1",
         "vertex numbers of each triangle, in tree order"},
        {SectionId::source_triangle, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "number in the imported file of each triangle of the tree order"},
        {SectionId::source_vertex, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "lowest number in the imported file of each vertex"},
        {SectionId::source_face, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "face of the imported mesh for each source triangle"},
        {SectionId::bvh_nodes, node_type, 0, "frame coordinates",
         "boxes of the hierarchy, eight a node, root first"},
        {SectionId::degenerate_bits, [] { return scalar(H5T_STD_U64LE); }, 0, "1",
         "bit i: triangle i of the tree order has collinear corners"},
        {SectionId::components, component_type, 0, "signed_volume: cubic model units",
         "connected components"},
        {SectionId::bounds, bounds_type, 0, "model units", "axis-aligned and oriented box"},
        {SectionId::mass_properties, mass_type, 0, "powers of the model unit, density 1",
         "volume, area, centre of mass, inertia xx yy zz xy yz zx"},
        {SectionId::instances, instance_type, 0, "model units",
         "uses of meshes by nodes of the imported scene"},
        {SectionId::instance_names, [] { return scalar(H5T_STD_U8LE); }, 0, "1",
         "node paths, UTF-8, each ended by a zero"},
        {SectionId::group_runs, run_type, 0, "1", "runs of source triangles of one group"},
        {SectionId::group_names, [] { return scalar(H5T_STD_U8LE); }, 0, "1",
         "group names, UTF-8, each ended by a zero"},
        {SectionId::material_runs, run_type, 0, "1", "runs of source triangles of one material"},
        {SectionId::material_names, [] { return scalar(H5T_STD_U8LE); }, 0, "1",
         "material names, UTF-8, each ended by a zero"},
        {SectionId::provenance, [] { return scalar(H5T_STD_U8LE); }, 0, "1",
         "canonical JSON, UTF-8: versions, options, hash of the source"},
        {SectionId::bvh_leaves, leaf_type, 0, "model units, or frame units less the origin",
         "corners of the eight triangles of each leaf, [corner][axis][triangle]"},
        {SectionId::oriented_nodes, oriented_type, 0, "frame coordinates",
         "oriented boxes of the hierarchy, eight a node, root first"},
        {SectionId::swept_nodes, swept_type, 0, "frame coordinates",
         "swept spheres of the hierarchy, eight a node, root first"},
        {SectionId::verdicts, verdict_type, 0, "area, volume: square and cubic model units",
         "what was found of the whole mesh, then of each component"},
        {SectionId::findings, [] { return scalar(H5T_STD_U8LE); }, 0, "1",
         "JSON, UTF-8: what was found wrong with the mesh, and what was mended"},
        {SectionId::repaired_from, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "number in the imported file of each triangle of the repaired mesh; 2^32 - 1: made"},
        {SectionId::octree_grid, octree_grid_type, 0, "origin, step: model units",
         "the cube that the octree divides, and how far"},
        {SectionId::octree_nodes, octree_node_type, 0, "1",
         "cells of the octree that triangles touch, sorted by key"},
        {SectionId::octree_references, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "triangles of each leaf, in tree order; bit 31: other leaves list it too"},
        {SectionId::octree_leaf_codes, [] { return scalar(H5T_STD_U64LE); }, 0, "1",
         "where the first finest cell of each leaf stands along the z curve"},
        {SectionId::octree_leaf_nodes, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "number of the node of each leaf along the z curve"},
        {SectionId::octree_top, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "leaves before each cell of top_level along the z curve, then all"},
        {SectionId::octree_modulus_table, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "first nodes by key modulo the slots, then next nodes, plus one; 0 ends a chain"},
        {SectionId::octree_mixed_table, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "the same by mixed key"},
        {SectionId::adaptive_octree, adaptive_octree_type, 0, "model units",
         "octree with split points of its own: its box, and how it was divided"},
        {SectionId::adaptive_octree_nodes, adaptive_octree_node_type, 0, "model units",
         "cells of the adaptive octree, level by level; count: bit 31 and children, or triangles"},
        {SectionId::adaptive_octree_references, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "triangles of the tree order that touch each leaf; bit 31: other leaves too"},
        {SectionId::tetra_tree, tetra_tree_type, 0, "centre: model units",
         "cones around a centre: where they meet, and how they were split"},
        {SectionId::tetra_nodes, tetra_node_type, 0, "radius_min, radius_max: frame units",
         "cones of the tetra-tree that triangles touch, sorted by key"},
        {SectionId::tetra_references, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "triangles that hold the centre, then of each leaf; bit 31: other leaves too"},
        {SectionId::tetra_top, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "for each cone of top_level its node, or the leaf above it, plus one; 0: none"},
        {SectionId::octree_boxes, cell_box_type, 0, "frame coordinates",
         "box around what each node of the octree holds"},
        {SectionId::adaptive_octree_boxes, cell_box_type, 0, "frame coordinates",
         "box around what each node of the adaptive octree holds"},
        {SectionId::tetra_boxes, node_type, 0, "frame coordinates",
         "element i: boxes of tetra_nodes 4i to 4i + 7"},
        {SectionId::tetra_oriented, oriented_type, 0, "frame coordinates",
         "the same, along the surface's own axes"},
        {SectionId::hulls, hull_type, 0, "distance, reach: model units",
         "convex hulls: of the whole, of components, of instances; where their parts begin"},
        {SectionId::hull_blocks, hull_block_type, 0, "model units",
         "points of hulls, eight side by side; the last of a hull fills its block"},
        {SectionId::hull_vertices, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "for each lane of hull_blocks its vertex in the imported file; 2^32 - 1: none"},
        {SectionId::hull_facets, hull_facet_type, 0, "1",
         "triangles of hulls; across: the facet beyond each edge; group: its coplanar face"},
        {SectionId::hull_groups, hull_group_type, 0, "1", "maximal coplanar faces of hulls"},
        {SectionId::hull_neighbours, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "for each larger hull where each point's neighbours begin and the last end, then those"},
        {SectionId::hull_starts, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "for each larger hull and 384 directions a point that is far in it"},
        {SectionId::pieces, piece_type, 0, "outer_error: model units",
         "convex pieces of the surface: where their lists begin, and what they promise"},
        {SectionId::piece_triangles, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "triangles of the tree order by piece"},
        {SectionId::piece_vertices, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "vertices that are the corners of each piece's hull"},
        {SectionId::piece_facets, piece_facet_type, 0, "1",
         "facets of each piece's hull, over its own corners; flags: 1 virtual, 2 a face begins"},
        {SectionId::piece_nodes, node_type, 0, "frame coordinates",
         "boxes of the hierarchy over pieces, eight a node, root first"},
        {SectionId::piece_swept, swept_type, 0, "frame coordinates",
         "swept rectangles around what the same boxes of piece_nodes hold"},
        {SectionId::piece_leaves, piece_leaf_type, 0, "1",
         "what boxes of the lowest piece_nodes hold: a run of piece_triangles, of one piece"},
        {SectionId::piece_node_hulls, piece_node_hull_type, 0, "model units",
         "convex hulls of few corners around what the upper piece_nodes hold"},
        {SectionId::piece_adjacency, piece_adjacency_type, 0, "1",
         "for each facet of a piece's hull the facets beyond its three edges"},
        {SectionId::edge_convexity, [] { return scalar(H5T_STD_U8LE); }, 0, "1",
         "two bits for each edge of a triangle: 0 unknown, 1 flat, 2 convex, 3 reflex"},
        {SectionId::triangle_piece, [] { return scalar(H5T_STD_U32LE); }, 0, "1",
         "number of the piece that each triangle is in"},
    };
    return all;
}

const Look* find_look(SectionId id) {
    for (const Look& look : looks()) {
        if (look.id == id) return &look;
    }
    return nullptr;
}

// --- Making ---------------------------------------------------------------------

bool add_text(hid_t object, const char* name, const char* text) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id(), std::strlen(text));
    H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(
        H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    return attribute.good() && H5Awrite(attribute.id(), type.id(), text) >= 0;
}

constexpr const char* kName = "in memory";

Handle access_list(SparseMemory& memory, std::uint64_t threshold, std::uint64_t alignment) {
    Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_alignment(list.id(), threshold, alignment);
    H5Pset_libver_bounds(list.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
    if (!keep_in_memory(list.id(), memory)) return {-1, H5Pclose};
    return list;
}

void keep_links_simple(const Handle& creation) {
    constexpr unsigned kMostCompactLinks = 65000;
    H5Pset_link_phase_change(creation.id(), kMostCompactLinks, 0);
    H5Pset_obj_track_times(creation.id(), false);
}

/// An empty file with a user block and our group.
bool make_file(SparseMemory& memory) {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_userblock(creation.id(), format::kUserBlockSize);
    keep_links_simple(creation);
    const Handle access = access_list(memory, 1, format::kSectionAlignment);
    Handle file(H5Fcreate(kName, H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
    if (!file.good()) return false;
    const Handle group_creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    keep_links_simple(group_creation);
    Handle group(H5Gcreate2(file.id(), kGroup, H5P_DEFAULT, group_creation.id(), H5P_DEFAULT),
                 H5Gclose);
    const bool described = group.good() && add_text(group.id(), "description",
                                                    "a mesh baked for exact collision queries");
    return described && group.close() && file.close();
}

std::vector<hsize_t> shape_of(const Look& look, std::uint64_t count) {
    if (look.columns == 0) return {count};
    return {count, look.columns};
}

std::optional<Place> make_dataset(const Handle& file, const Plan& plan) {
    const Look* look = find_look(plan.id);
    if (look == nullptr) return std::nullopt;
    const std::vector<hsize_t> shape = shape_of(*look, plan.count);
    const Handle type = look->type();
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation.id(), false);
    H5Pset_layout(creation.id(), H5D_CONTIGUOUS);
    H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
    const std::string name = std::string(kGroup) + "/" + format::section_name(plan.id);
    Handle dataset(H5Dcreate2(file.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT,
                              creation.id(), H5P_DEFAULT),
                   H5Dclose);
    if (!dataset.good() || !add_text(dataset.id(), "units", look->units) ||
        !add_text(dataset.id(), "description", look->description)) {
        return std::nullopt;
    }
    const haddr_t offset = H5Dget_offset(dataset.id());
    if (offset == HADDR_UNDEF || !dataset.close()) return std::nullopt;
    return Place{plan.id, offset, plan.count};
}

bool is_large(const Plan& plan) {
    return plan.count * format::element_size(plan.id) >= format::kPageThreshold;
}

/// Makes the large or the small datasets, all in one open.
bool make_datasets(SparseMemory& memory, std::span<const Plan> plans, bool large,
                   std::vector<Place>& places) {
    const Handle access = large
                              ? access_list(memory, format::kPageThreshold, format::kPageAlignment)
                              : access_list(memory, 1, format::kSectionAlignment);
    Handle file(H5Fopen(kName, H5F_ACC_RDWR, access.id()), H5Fclose);
    if (!file.good()) return false;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (is_large(plans[i]) != large) continue;
        const std::optional<Place> place = make_dataset(file, plans[i]);
        if (!place) return false;
        places[i] = *place;
    }
    return file.close();
}

// --- Finding --------------------------------------------------------------------

std::string clause(SectionId id, const char* what) {
    return std::string("dataset ") + format::section_name(id) + " " + what;
}

/// One dataset of a file that somebody else may have written.
std::string find_place(const Handle& file, const Look& look, std::vector<Place>& places) {
    const std::string name = std::string(kGroup) + "/" + format::section_name(look.id);
    if (H5Lexists(file.id(), name.c_str(), H5P_DEFAULT) <= 0) return {};
    const Handle dataset(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.good()) return clause(look.id, "cannot be opened");
    const Handle type(H5Dget_type(dataset.id()), H5Tclose);
    const Handle expected = look.type();
    if (H5Tequal(type.id(), expected.id()) <= 0) return clause(look.id, "has another type");
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    std::array<hsize_t, 2> shape{};
    const int expected_rank = look.columns == 0 ? 1 : 2;
    if (H5Sget_simple_extent_ndims(space.id()) != expected_rank ||
        H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr) != expected_rank ||
        (look.columns != 0 && shape[1] != look.columns)) {
        return clause(look.id, "has another shape");
    }
    const Handle creation(H5Dget_create_plist(dataset.id()), H5Pclose);
    const haddr_t offset = H5Dget_offset(dataset.id());
    if (H5Pget_layout(creation.id()) != H5D_CONTIGUOUS || offset == HADDR_UNDEF) {
        return clause(look.id, "is not stored as one uncompressed run");
    }
    places.push_back({look.id, offset, shape[0]});
    return {};
}

}  // namespace

std::optional<Layout> make_layout(std::span<const Plan> plans) {
    const Silence silence;
    Layout layout{std::vector<Place>(plans.size()), {}};
    const bool made = make_file(layout.rest) &&
                      make_datasets(layout.rest, plans, true, layout.places) &&
                      make_datasets(layout.rest, plans, false, layout.places);
    if (!made) return std::nullopt;
    return layout;
}

FoundLayout find_layout(const std::filesystem::path& path) {
    const Silence silence;
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.good()) return {{}, "it is not an HDF5 file that can be read"};
    FoundLayout found;
    for (const Look& look : looks()) {
        const std::string damage = find_place(file, look, found.places);
        if (!damage.empty()) return {{}, damage};
    }
    if (found.places.empty()) found.damage = "it holds no dataset of cdprep";
    return found;
}

}  // namespace cdprep::write
