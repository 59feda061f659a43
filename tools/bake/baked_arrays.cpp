// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/baked_arrays.h"

#include <bit>
#include <numeric>
#include <utility>

#include "bake/section_list.h"
#include "cdprep/cells/section_list.h"

namespace cdprep::cli {
namespace {

using format::SectionId;

/// The names one after the other, each followed by a zero byte.
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

build::SectionList BakedArrays::sections(format::SectionSet wanted) const {
    build::SectionList list(wanted);
    if (mesh_.single_precision) {
        list.add(SectionId::positions_f32, floats_);
    } else {
        list.add(SectionId::positions_f64, mesh_.positions);
    }
    list.add(SectionId::triangles, mesh_.triangles);
    list.add(SectionId::source_vertex, mesh_.source_vertex);
    list.add_unless_empty(SectionId::source_face, face_);
    add_sections(list, bvh_);
    list.add_unless_empty(SectionId::degenerate_bits, degenerate_);
    list.add(SectionId::components, components_);
    list.add_unless_empty(SectionId::bounds, bounds_);
    list.add_unless_empty(SectionId::mass_properties, mass_);
    list.add_unless_empty(SectionId::instances, instances_);
    list.add_unless_empty(SectionId::instance_names, instance_names_);
    list.add_unless_empty(SectionId::group_runs, groups_.runs);
    list.add_unless_empty(SectionId::group_names, group_names_);
    list.add_unless_empty(SectionId::material_runs, materials_.runs);
    list.add_unless_empty(SectionId::material_names, material_names_);
    list.add_unless_empty(SectionId::provenance, notes_.provenance);
    list.add_unless_empty(SectionId::verdicts, notes_.verdicts);
    list.add_unless_empty(SectionId::findings, notes_.findings);
    list.add_unless_empty(SectionId::repaired_from, notes_.repaired_from);
    add_sections(list, structures_.octree);
    add_sections(list, structures_.adaptive_octree);
    add_sections(list, structures_.tetra_tree);
    add_sections(list, structures_.hulls);
    add_sections(list, pieces_);
    add_sections(list, piece_tree_);
    add_sections(list, contacts_);
    return list;
}

}  // namespace cdprep::cli
