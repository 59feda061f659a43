// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/hulls.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/format/verdict.h"

namespace cdprep {

using format::Double3;
using format::Float3;

// Views of the sections of an open model, as Model returns them. A span is empty and a pointer is
// null when the file lacks the section or it was not opened. Spans stay valid while the Model
// lives. FORMAT.md describes the elements and says which arrays are in tree order, the order in
// which the BVH stores triangles.

/// The triangles of a model. A file has one kind of positions; an opened model has it when its
/// vertices were asked for.
struct MeshView {
    std::span<const Float3> positions_f32;           ///< model units
    std::span<const Double3> positions_f64;          ///< model units
    std::span<const format::Triangle> triangles;     ///< tree order
    std::span<const std::uint64_t> degenerate_bits;  ///< a bit for each triangle, tree order
    /// By triangle, tree order; format::edge_convexity() reads an element. Needs Ask::contacts.
    std::span<const std::uint8_t> edge_convexity;
};

/// The way from numbers of a model to those of the imported file.
struct SourceView {
    std::span<const std::uint32_t> triangle;  ///< by triangle, tree order
    std::span<const std::uint32_t> vertex;    ///< by vertex
    std::span<const std::uint32_t> face;      ///< by source triangle; the polygon it is cut from
    /// By source triangle: its number before `bake --repair`, or format::kMadeByRepair. Empty
    /// when nothing was repaired; numbers are then the file's.
    std::span<const std::uint32_t> repaired_from;
    std::span<const format::Instance> instances;
    std::span<const format::NamedRun> group_runs;
    std::span<const format::NamedRun> material_runs;
};

/// The bounding volume hierarchy over all triangles.
struct BvhView {
    std::span<const format::BvhNode> nodes;  ///< root first
    std::span<const format::BvhLeaf> leaves;
    std::span<const format::OrientedNode> oriented;  ///< numbered as `nodes`
    /// Numbered as `nodes`; format::swept_kind(header().flags) says which volumes they are.
    std::span<const format::SweptNode> swept;
    format::BvhShape shape;  ///< levels and counts; always set
};

/// The octree of equal cells, its hash tables and its sorted leaves (format/octree.h).
struct OctreeView {
    const format::OctreeGrid* grid = nullptr;
    std::span<const format::OctreeNode> nodes;
    std::span<const std::uint32_t> references;
    std::span<const std::uint64_t> leaf_codes;
    std::span<const std::uint32_t> leaf_nodes;
    std::span<const std::uint32_t> top;
    std::span<const std::uint32_t> modulus_table;
    std::span<const std::uint32_t> mixed_table;
    std::span<const format::CellBox> boxes;  ///< by node
};

/// The octree whose nodes choose their split points (format/octree.h).
struct AdaptiveOctreeView {
    const format::AdaptiveOctree* tree = nullptr;
    std::span<const format::AdaptiveOctreeNode> nodes;
    std::span<const std::uint32_t> references;
    std::span<const format::CellBox> boxes;  ///< by node
};

/// The tetra-tree (format/tetra_tree.h).
struct TetraTreeView {
    const format::TetraTree* tree = nullptr;
    std::span<const format::TetraNode> nodes;
    std::span<const std::uint32_t> references;
    std::span<const std::uint32_t> top;
    std::span<const format::BvhNode> boxes;
    std::span<const format::OrientedNode> oriented;
};

/// Convex hulls of the whole, of components, instances and parts (format/hulls.h). find_hull()
/// and convex_points() read them.
struct HullView {
    std::span<const format::Hull> hulls;
    std::span<const format::HullBlock> blocks;
    std::span<const std::uint32_t> vertices;
    std::span<const format::HullFacet> facets;
    std::span<const format::HullGroup> groups;
    std::span<const std::uint32_t> neighbours;
    std::span<const std::uint32_t> starts;
};

/// Convex pieces of the surface, their hulls, and the hierarchy over them (format/pieces.h).
/// feature_hull() reads one.
struct PieceView {
    std::span<const format::Piece> pieces;
    std::span<const std::uint32_t> triangles;
    std::span<const std::uint32_t> vertices;
    std::span<const format::PieceFacet> facets;
    std::span<const format::PieceAdjacency> adjacency;
    std::span<const format::BvhNode> nodes;  ///< root first
    std::span<const format::SweptNode> swept;
    std::span<const format::PieceLeaf> leaves;
    std::span<const format::PieceNodeHull> node_hulls;
    std::span<const std::uint32_t> of_triangle;  ///< the piece of each triangle, tree order
};

/// The facts that the bake recorded about the mesh.
struct RecordView {
    /// Of the whole mesh, then of each component in the order of their lowest source triangle.
    std::span<const format::Verdict> verdicts;
    std::span<const format::Component> components;
    const format::Bounds* bounds = nullptr;
    const format::MassProperties* mass = nullptr;
    std::string_view provenance;  ///< canonical JSON
    std::string_view findings;    ///< JSON: the defects of the mesh, and the repairs
};

}  // namespace cdprep
