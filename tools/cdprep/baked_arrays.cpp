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
    return sections;
}

}  // namespace cdprep::cli
