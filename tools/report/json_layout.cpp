// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/json_layout.h"

#include <array>

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLineLength = 100;

struct CountName {
    const char* name;
    std::uint64_t mesh::DefectCounts::*count;
};

constexpr std::array<CountName, 25> kCounts = {{
    {"non_finite_vertices", &mesh::DefectCounts::non_finite_vertices},
    {"out_of_range_triangles", &mesh::DefectCounts::out_of_range_triangles},
    {"unreferenced_vertices", &mesh::DefectCounts::unreferenced_vertices},
    {"duplicate_vertices", &mesh::DefectCounts::duplicate_vertices},
    {"degenerate_triangles", &mesh::DefectCounts::degenerate_triangles},
    {"zero_area_triangles", &mesh::DefectCounts::zero_area_triangles},
    {"sliver_triangles", &mesh::DefectCounts::sliver_triangles},
    {"duplicate_triangles", &mesh::DefectCounts::duplicate_triangles},
    {"opposite_triangles", &mesh::DefectCounts::opposite_triangles},
    {"boundary_edges", &mesh::DefectCounts::boundary_edges},
    {"boundary_loops", &mesh::DefectCounts::boundary_loops},
    {"non_manifold_edges", &mesh::DefectCounts::non_manifold_edges},
    {"non_manifold_vertices", &mesh::DefectCounts::non_manifold_vertices},
    {"inconsistent_edges", &mesh::DefectCounts::inconsistent_edges},
    {"non_orientable_components", &mesh::DefectCounts::non_orientable_components},
    {"t_junctions", &mesh::DefectCounts::t_junctions},
    {"near_seams", &mesh::DefectCounts::near_seams},
    {"components", &mesh::DefectCounts::components},
    {"inverted_components", &mesh::DefectCounts::inverted_components},
    {"nested_components", &mesh::DefectCounts::nested_components},
    {"overlapping_components", &mesh::DefectCounts::overlapping_components},
    {"crossing_pairs", &mesh::DefectCounts::crossing_pairs},
    {"touching_pairs", &mesh::DefectCounts::touching_pairs},
    {"coplanar_overlap_pairs", &mesh::DefectCounts::coplanar_overlap_pairs},
    {"self_intersecting_pairs", &mesh::DefectCounts::self_intersecting_pairs},
}};
static_assert(sizeof(mesh::DefectCounts) == kCounts.size() * sizeof(std::uint64_t));

/// The items in brackets: on one line when they fit, else one a line.
std::string bracketed(const char* brackets, const std::vector<std::string>& items, int depth) {
    std::size_t size = 1 + items.size();
    bool is_broken = false;
    for (const std::string& item : items) {
        size += item.size();
        is_broken = is_broken || item.find('\n') != std::string::npos;
    }
    const bool fits = size <= kLineLength && !is_broken;
    std::string indent;
    if (!fits) {
        indent += '\n';
        indent.append(static_cast<std::size_t>(depth), ' ');
    }
    std::string text(1, brackets[0]);
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i > 0) text += ',';
        if (!fits) text += indent + ' ';
        text += items[i];
    }
    return text + indent + brackets[1];
}

}  // namespace

std::string compact(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string valid_utf8(std::string_view text) {
    return Json::parse(compact(Json(text))).get<std::string>();
}

std::string laid_out(const Json& json, int depth) {
    if (!json.is_structured()) return compact(json);
    std::vector<std::string> items;
    if (json.is_array()) {
        for (const Json& item : json) items.push_back(laid_out(item, depth + 1));
        return bracketed("[]", items, depth);
    }
    for (const auto& [key, value] : json.items()) {
        items.push_back(compact(key) + ":" + laid_out(value, depth + 1));
    }
    return bracketed("{}", items, depth);
}

Json counts_json(const mesh::DefectCounts& counts) {
    Json json = Json::object();
    for (const CountName& entry : kCounts) json[entry.name] = counts.*entry.count;
    return json;
}

Json position_json(const mesh::Double3& position) {
    return Json::array({position.x, position.y, position.z});
}

}  // namespace cdprep::report
