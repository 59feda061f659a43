// SPDX-License-Identifier: GPL-3.0-or-later
#include "baked_arrays.h"

#include <bit>
#include <numeric>
#include <span>
#include <utility>

namespace cdprep::cli {
namespace {

using format::SectionId;

/// Each name ended by a zero byte.
std::string ended_names(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += name + '\0';
    return text;
}

std::vector<format::Float3> as_floats(const mesh::Mesh& mesh) {
    std::vector<format::Float3> floats;
    if (!mesh.single_precision) return floats;
    floats.reserve(mesh.positions.size());
    for (const mesh::Double3& p : mesh.positions) {
        floats.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    return floats;
}

template <class Range>
std::span<const std::byte> bytes_of(const Range& elements) {
    return std::as_bytes(std::span(elements.data(), elements.size()));
}

template <class Element>
std::span<const std::byte> bytes_of_one(const Element& element) {
    return std::as_bytes(std::span(&element, 1));
}

/// A tree is stored with all its sections or with none, so also with those that a mesh
/// without triangles leaves empty.
template <class Add>
void add_structures(const Structures& structures, const Add& add) {
    const build::Octree& octree = structures.octree;
    add(SectionId::octree_grid, bytes_of_one(octree.grid), true);
    add(SectionId::octree_nodes, bytes_of(octree.nodes), true);
    add(SectionId::octree_references, bytes_of(octree.references), true);
    add(SectionId::octree_leaf_codes, bytes_of(octree.leaf_codes), true);
    add(SectionId::octree_leaf_nodes, bytes_of(octree.leaf_nodes), true);
    add(SectionId::octree_top, bytes_of(octree.top), true);
    add(SectionId::octree_modulus_table, bytes_of(octree.modulus_table), true);
    add(SectionId::octree_mixed_table, bytes_of(octree.mixed_table), true);
    const build::AdaptiveOctree& adaptive = structures.adaptive_octree;
    add(SectionId::adaptive_octree, bytes_of_one(adaptive.tree), true);
    add(SectionId::adaptive_octree_nodes, bytes_of(adaptive.nodes), true);
    add(SectionId::adaptive_octree_references, bytes_of(adaptive.references), true);
    add(SectionId::octree_boxes, bytes_of(octree.boxes), true);
    add(SectionId::adaptive_octree_boxes, bytes_of(adaptive.boxes), true);
    const build::TetraTree& tetra = structures.tetra_tree;
    add(SectionId::tetra_tree, bytes_of_one(tetra.tree), true);
    add(SectionId::tetra_nodes, bytes_of(tetra.nodes), true);
    add(SectionId::tetra_references, bytes_of(tetra.references), true);
    add(SectionId::tetra_top, bytes_of(tetra.top), true);
    add(SectionId::tetra_boxes, bytes_of(tetra.boxes), true);
    add(SectionId::tetra_oriented, bytes_of(tetra.oriented), true);
    const convex::HullSections& hulls = structures.hulls;
    add(SectionId::hulls, bytes_of(hulls.hulls), true);
    add(SectionId::hull_blocks, bytes_of(hulls.blocks), true);
    add(SectionId::hull_vertices, bytes_of(hulls.vertices), true);
    add(SectionId::hull_facets, bytes_of(hulls.facets), true);
    add(SectionId::hull_groups, bytes_of(hulls.groups), true);
    add(SectionId::hull_neighbours, bytes_of(hulls.neighbours), true);
    add(SectionId::hull_starts, bytes_of(hulls.starts), true);
}

}  // namespace

BakedArrays::BakedArrays(const mesh::TriangleSoup& soup, mesh::Mesh ordered, build::Bvh bvh,
                         std::vector<std::uint64_t> degenerate,
                         std::vector<format::Component> components, const format::Bounds& bounds,
                         const std::optional<format::MassProperties>& mass, BakedNotes notes)
    : mesh_(std::move(ordered)),
      bvh_(std::move(bvh)),
      degenerate_(std::move(degenerate)),
      components_(std::move(components)),
      bounds_{bounds},
      notes_(std::move(notes)),
      floats_(as_floats(mesh_)),
      face_(soup.face),
      instances_(soup.instances),
      groups_(soup.groups),
      materials_(soup.materials),
      instance_names_(ended_names(soup.instance_names)),
      group_names_(ended_names(soup.groups.names)),
      material_names_(ended_names(soup.materials.names)) {
    if (mass) mass_.push_back(*mass);
}

std::size_t BakedArrays::degenerate_count() const noexcept {
    return std::accumulate(degenerate_.begin(), degenerate_.end(), std::size_t{0},
                           [](std::size_t sum, std::uint64_t word) {
                               return sum + static_cast<std::size_t>(std::popcount(word));
                           });
}

void BakedArrays::keep(Structures structures) {
    structures_ = std::move(structures);
}

void BakedArrays::keep(convex::PieceArrays pieces, convex::PieceTree tree) {
    pieces_ = std::move(pieces);
    piece_tree_ = std::move(tree);
}

void BakedArrays::keep(convex::ContactArrays contacts) {
    contacts_ = std::move(contacts);
}

std::vector<write::Section> BakedArrays::sections(format::SectionSet wanted) const {
    std::vector<write::Section> sections;
    const auto add = [&](SectionId id, std::span<const std::byte> bytes, bool also_empty) {
        if (wanted.contains(id) && (also_empty || !bytes.empty())) sections.push_back({id, bytes});
    };
    if (mesh_.single_precision) {
        add(SectionId::positions_f32, bytes_of(floats_), true);
    } else {
        add(SectionId::positions_f64, bytes_of(mesh_.positions), true);
    }
    add(SectionId::triangles, bytes_of(mesh_.triangles), true);
    add(SectionId::source_triangle, bytes_of(bvh_.order), true);
    add(SectionId::source_vertex, bytes_of(mesh_.source_vertex), true);
    add(SectionId::source_face, bytes_of(face_), false);
    add(SectionId::bvh_nodes, bytes_of(bvh_.nodes), true);
    add(SectionId::degenerate_bits, bytes_of(degenerate_), false);
    add(SectionId::components, bytes_of(components_), true);
    add(SectionId::bounds, bytes_of(bounds_), false);
    add(SectionId::mass_properties, bytes_of(mass_), false);
    add(SectionId::instances, bytes_of(instances_), false);
    add(SectionId::instance_names, bytes_of(instance_names_), false);
    add(SectionId::group_runs, bytes_of(groups_.runs), false);
    add(SectionId::group_names, bytes_of(group_names_), false);
    add(SectionId::material_runs, bytes_of(materials_.runs), false);
    add(SectionId::material_names, bytes_of(material_names_), false);
    add(SectionId::provenance, bytes_of(notes_.provenance), false);
    add(SectionId::bvh_leaves, bytes_of(bvh_.leaves), true);
    add(SectionId::oriented_nodes, bytes_of(bvh_.oriented_nodes), false);
    add(SectionId::swept_nodes, bytes_of(bvh_.swept_nodes), false);
    add(SectionId::verdicts, bytes_of(notes_.verdicts), false);
    add(SectionId::findings, bytes_of(notes_.findings), false);
    add(SectionId::repaired_from, bytes_of(notes_.repaired_from), false);
    add_structures(structures_, add);
    add(SectionId::pieces, bytes_of(pieces_.pieces), true);
    add(SectionId::piece_triangles, bytes_of(pieces_.triangles), true);
    add(SectionId::piece_vertices, bytes_of(pieces_.vertices), true);
    add(SectionId::piece_facets, bytes_of(pieces_.facets), true);
    add(SectionId::piece_nodes, bytes_of(piece_tree_.nodes), true);
    add(SectionId::piece_swept, bytes_of(piece_tree_.swept), true);
    add(SectionId::piece_leaves, bytes_of(piece_tree_.leaves), true);
    add(SectionId::piece_node_hulls, bytes_of(piece_tree_.hulls), true);
    add(SectionId::piece_adjacency, bytes_of(contacts_.adjacency), true);
    add(SectionId::edge_convexity, bytes_of(contacts_.convexity), true);
    add(SectionId::triangle_piece, bytes_of(contacts_.piece_of), true);
    return sections;
}

}  // namespace cdprep::cli
