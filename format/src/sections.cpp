// SPDX-License-Identifier: MIT
#include "cdprep/format/sections.h"

#include <array>
#include <cstring>

#include "cdprep/format/geometry.h"
#include "cdprep/format/hulls.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/format/verdict.h"

namespace cdprep::format {
namespace {

struct Kind {
    SectionId id;
    std::uint32_t element_size;
    const char* name;
};

constexpr std::array<Kind, 61> kKinds = {{
    {SectionId::positions_f32, sizeof(Float3), "positions_f32"},
    {SectionId::positions_f64, sizeof(Double3), "positions_f64"},
    {SectionId::triangles, sizeof(Triangle), "triangles"},
    {SectionId::source_triangle, 4, "source_triangle"},
    {SectionId::source_vertex, 4, "source_vertex"},
    {SectionId::source_face, 4, "source_face"},
    {SectionId::bvh_nodes, sizeof(BvhNode), "bvh_nodes"},
    {SectionId::degenerate_bits, 8, "degenerate_bits"},
    {SectionId::components, sizeof(Component), "components"},
    {SectionId::bounds, sizeof(Bounds), "bounds"},
    {SectionId::mass_properties, sizeof(MassProperties), "mass_properties"},
    {SectionId::instances, sizeof(Instance), "instances"},
    {SectionId::instance_names, 1, "instance_names"},
    {SectionId::group_runs, sizeof(NamedRun), "group_runs"},
    {SectionId::group_names, 1, "group_names"},
    {SectionId::material_runs, sizeof(NamedRun), "material_runs"},
    {SectionId::material_names, 1, "material_names"},
    {SectionId::provenance, 1, "provenance"},
    {SectionId::bvh_leaves, sizeof(BvhLeaf), "bvh_leaves"},
    {SectionId::oriented_nodes, sizeof(OrientedNode), "oriented_nodes"},
    {SectionId::swept_nodes, sizeof(SweptNode), "swept_nodes"},
    {SectionId::verdicts, sizeof(Verdict), "verdicts"},
    {SectionId::findings, 1, "findings"},
    {SectionId::repaired_from, 4, "repaired_from"},
    {SectionId::octree_grid, sizeof(OctreeGrid), "octree_grid"},
    {SectionId::octree_nodes, sizeof(OctreeNode), "octree_nodes"},
    {SectionId::octree_references, 4, "octree_references"},
    {SectionId::octree_leaf_codes, 8, "octree_leaf_codes"},
    {SectionId::octree_leaf_nodes, 4, "octree_leaf_nodes"},
    {SectionId::octree_top, 4, "octree_top"},
    {SectionId::octree_modulus_table, 4, "octree_modulus_table"},
    {SectionId::octree_mixed_table, 4, "octree_mixed_table"},
    {SectionId::adaptive_octree, sizeof(AdaptiveOctree), "adaptive_octree"},
    {SectionId::adaptive_octree_nodes, sizeof(AdaptiveOctreeNode), "adaptive_octree_nodes"},
    {SectionId::adaptive_octree_references, 4, "adaptive_octree_references"},
    {SectionId::tetra_tree, sizeof(TetraTree), "tetra_tree"},
    {SectionId::tetra_nodes, sizeof(TetraNode), "tetra_nodes"},
    {SectionId::tetra_references, 4, "tetra_references"},
    {SectionId::tetra_top, 4, "tetra_top"},
    {SectionId::tetra_boxes, sizeof(BvhNode), "tetra_boxes"},
    {SectionId::octree_boxes, sizeof(CellBox), "octree_boxes"},
    {SectionId::adaptive_octree_boxes, sizeof(CellBox), "adaptive_octree_boxes"},
    {SectionId::tetra_oriented, sizeof(OrientedNode), "tetra_oriented"},
    {SectionId::hulls, sizeof(Hull), "hulls"},
    {SectionId::hull_blocks, sizeof(HullBlock), "hull_blocks"},
    {SectionId::hull_vertices, 4, "hull_vertices"},
    {SectionId::hull_facets, sizeof(HullFacet), "hull_facets"},
    {SectionId::hull_groups, sizeof(HullGroup), "hull_groups"},
    {SectionId::hull_neighbours, 4, "hull_neighbours"},
    {SectionId::hull_starts, 4, "hull_starts"},
    {SectionId::pieces, sizeof(Piece), "pieces"},
    {SectionId::piece_triangles, 4, "piece_triangles"},
    {SectionId::piece_vertices, 4, "piece_vertices"},
    {SectionId::piece_facets, sizeof(PieceFacet), "piece_facets"},
    {SectionId::piece_nodes, sizeof(BvhNode), "piece_nodes"},
    {SectionId::piece_leaves, sizeof(PieceLeaf), "piece_leaves"},
    {SectionId::piece_swept, sizeof(SweptNode), "piece_swept"},
    {SectionId::piece_node_hulls, sizeof(PieceNodeHull), "piece_node_hulls"},
    {SectionId::piece_adjacency, sizeof(PieceAdjacency), "piece_adjacency"},
    {SectionId::edge_convexity, 1, "edge_convexity"},
    {SectionId::triangle_piece, 4, "triangle_piece"},
}};

const Kind* find_kind(SectionId id) noexcept {
    for (const Kind& kind : kKinds) {
        if (kind.id == id) return &kind;
    }
    return nullptr;
}

}  // namespace

FileHeader read_header(std::span<const std::byte> file) noexcept {
    FileHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    return header;
}

std::optional<SectionEntry> find_section(std::span<const std::byte> file, SectionId id) noexcept {
    const FileHeader header = read_header(file);
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
        SectionEntry entry;
        std::memcpy(&entry, file.data() + kSectionTableOffset + i * sizeof entry, sizeof entry);
        if (entry.id == id) return entry;
    }
    return std::nullopt;
}

std::uint32_t element_size(SectionId id) noexcept {
    const Kind* kind = find_kind(id);
    return kind ? kind->element_size : 0;
}

const char* section_name(SectionId id) noexcept {
    const Kind* kind = find_kind(id);
    return kind ? kind->name : "unknown";
}

}  // namespace cdprep::format
