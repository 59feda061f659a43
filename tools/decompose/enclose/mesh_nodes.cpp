// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/mesh_nodes.h"

#include <algorithm>
#include <array>

#include "cli/colliders.h"
#include "decompose/enclose/separate_nodes.h"
#include "mesh/component_numbers.h"
#include "mesh/topology.h"

namespace cdprep::cli {
namespace {

std::string last_name(const std::string& path) {
    return path.substr(path.find_last_of('/') + 1);
}

/// Returns true if the name marks a convex node, by the conventions of exporters for engines.
bool is_tagged_convex(const std::string& path) {
    const std::string name = last_name(path);
    constexpr std::array<const char*, 4> kEndings = {"-convcol", "-convcolonly", "-convex",
                                                     "_convex"};
    return name.starts_with("UCX_") ||
           std::any_of(kEndings.begin(), kEndings.end(),
                       [&](const char* ending) { return name.ends_with(ending); });
}

/// Returns true if the name marks a collider. Godot takes ...-colonly as it is, convex or not.
bool is_tagged_collider(const std::string& path) {
    return is_tagged_convex(path) || is_collider(path);
}

template <class Run>
void fill_run(std::vector<std::uint32_t>& node_of, const Run& run, std::uint32_t node) {
    std::fill_n(node_of.begin() + run.first_triangle, run.triangle_count, node);
}

/// Returns, for each group, true if it is balanced without the others.
std::vector<bool> find_balanced(const mesh::Mesh& mesh, const std::vector<std::uint32_t>& group_of,
                                std::size_t count) {
    const mesh::Mesh separated = convex::separate_nodes(mesh, group_of);
    const mesh::ComponentNumbers numbers = mesh::number_components(separated);
    const std::vector<format::Component> components = mesh::find_topology(separated).components;
    std::vector<bool> is_balanced(count, true);
    for (std::size_t i = 0; i < separated.triangles.size(); ++i) {
        const std::uint32_t component = numbers.of_vertex[separated.triangles[i].vertex[0]];
        if ((components[component].flags & format::component_balanced) == 0) {
            is_balanced[group_of[i]] = false;
        }
    }
    return is_balanced;
}

}  // namespace

MeshNodes find_nodes(const mesh::TriangleSoup& soup, const mesh::Mesh& mesh) {
    MeshNodes nodes;
    const bool has_groups = soup.instances.empty() && soup.groups.names.size() > 1;
    if (soup.instances.empty() && !has_groups) return nodes;
    nodes.node_of.assign(soup.triangles.size(), 0);
    if (has_groups) {
        nodes.names = soup.groups.names;
        for (const format::NamedRun& run : soup.groups.runs) {
            fill_run(nodes.node_of, run, run.name);
        }
    }
    for (std::uint32_t i = 0; i < soup.instances.size(); ++i) {
        nodes.names.push_back(soup.instance_names[soup.instances[i].name]);
        fill_run(nodes.node_of, soup.instances[i], i);
    }
    for (const std::string& name : nodes.names) {
        nodes.is_convex.push_back(is_tagged_convex(name) ? 1 : 0);
    }
    if (!has_groups) return nodes;
    const auto others = static_cast<std::uint32_t>(nodes.names.size());
    const std::vector<bool> is_balanced = find_balanced(mesh, nodes.node_of, others);
    for (std::uint32_t& node : nodes.node_of) {
        if (!is_balanced[node] && !is_tagged_collider(nodes.names[node])) node = others;
    }
    nodes.names.emplace_back();
    nodes.is_convex.push_back(0);
    return nodes;
}

}  // namespace cdprep::cli
