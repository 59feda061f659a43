// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/elements.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/hulls.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/format/verdict.h"

namespace cdprep {

using format::Double3;
using format::Float3;

// Views of the sections of an open model, as Model returns them. section_table.inc describes the
// members of the views, one per row. A span is empty and a pointer null if the file lacks the
// section or the section was not opened. Views stay valid while the Model lives. FORMAT.md
// describes the elements and states which arrays are in tree order, the order in which the BVH
// stores triangles.

/// The member type for a section: a span of its elements, a pointer to the only one, or text.
template <class Element>
struct SectionViewOf {
    using type = std::span<const Element>;
};
template <class Element>
struct SectionViewOf<format::One<Element>> {
    using type = const Element*;
};
template <>
struct SectionViewOf<format::Text> {
    using type = std::string_view;
};
template <class Element>
using SectionView = typename SectionViewOf<Element>::type;

// The rows of section_table.inc name element types of cdprep::format without the namespace.
namespace views {

using namespace format;

/// The triangles of a model. A file has positions in one precision only. An open model has
/// positions only if it was opened with them.
struct MeshView {
#define CDPREP_MESH_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

/// The map from triangle and vertex numbers of a model to those of the imported file. Also holds
/// that file's instances, groups and materials.
struct SourceView {
#define CDPREP_SOURCE_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

/// The bounding volume hierarchy over all triangles.
struct BvhView {
#define CDPREP_BVH_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
    BvhShape shape;  ///< levels and counts; always set
    /// For a LiveModel that can tear, and for a Window, one byte per leaf: a bit for each place
    /// that has a triangle. Empty for all other models, where every place has a triangle.
    std::span<const std::uint8_t> lanes = {};
};

/// The octree of equal cells, its hash tables and its sorted leaves (format/octree.h).
struct OctreeView {
#define CDPREP_OCTREE_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

/// The octree with a split point chosen for each node (format/octree.h).
struct AdaptiveOctreeView {
#define CDPREP_ADAPTIVE_OCTREE_SECTION(member, name, id, Element, ...) \
    SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

/// The tetra-tree (format/tetra_tree.h).
struct TetraTreeView {
#define CDPREP_TETRA_TREE_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

/// Convex hulls of the whole model, of components, instances and parts (format/hulls.h).
/// find_hull() and convex_points() read them.
struct HullView {
#define CDPREP_HULL_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

/// Convex pieces of the surface, their hulls, and the hierarchy over them (format/pieces.h).
/// feature_hull() returns the hull of one piece.
struct PieceView {
#define CDPREP_PIECE_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

/// The facts that the bake recorded about the mesh.
struct RecordView {
#define CDPREP_RECORD_SECTION(member, name, id, Element, ...) SectionView<Element> member = {};
#include "cdprep/format/section_table.inc"
};

}  // namespace views

using views::AdaptiveOctreeView;
using views::BvhView;
using views::HullView;
using views::MeshView;
using views::OctreeView;
using views::PieceView;
using views::RecordView;
using views::SourceView;
using views::TetraTreeView;

}  // namespace cdprep
