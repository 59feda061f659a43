// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "repair/ray_along_x.h"
#include "repair/repair_steps.h"
#include "repair/stored_verdict.h"

namespace cdprep::mesh {
namespace {

struct ComponentBox {
    Double3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                  std::numeric_limits<double>::infinity()};
    Double3 upper{-lower.x, -lower.y, -lower.z};
};

ComponentBox box_of(const RepairMesh& mesh, const StoredComponent& component) {
    ComponentBox box;
    for (const std::uint32_t t : component.triangles) {
        for (const std::uint32_t vertex : mesh.triangles[t].vertex) {
            const Double3& p = mesh.positions[vertex];
            box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                         std::min(box.lower.z, p.z)};
            box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                         std::max(box.upper.z, p.z)};
        }
    }
    return box;
}

bool contains(const ComponentBox& outer, const ComponentBox& inner) {
    return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y &&
           outer.lower.z <= inner.lower.z && outer.upper.x >= inner.upper.x &&
           outer.upper.y >= inner.upper.y && outer.upper.z >= inner.upper.z;
}

/// Returns whether p lies inside the component: an odd winding number. Nothing on its surface.
std::optional<bool> is_within(const RepairMesh& mesh, const StoredComponent& component,
                              const Double3& p) {
    int winding = 0;
    for (const std::uint32_t t : component.triangles) {
        const auto& v = mesh.triangles[t].vertex;
        const WindingTerm term = winding_term_along_x(
            p, {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]});
        if (term.on_surface) return std::nullopt;
        winding += term.crossings;
    }
    return winding % 2 != 0;
}

/// Returns whether the first vertex of `inner` off the surface of `outer` lies inside `outer`.
/// False if there is none.
bool is_within(const RepairMesh& mesh, const StoredComponent& outer, const StoredComponent& inner) {
    std::set<std::uint32_t> tested;
    for (const std::uint32_t t : inner.triangles) {
        for (const std::uint32_t vertex : mesh.triangles[t].vertex) {
            if (!tested.insert(vertex).second) continue;
            if (const auto within = is_within(mesh, outer, mesh.positions[vertex])) return *within;
        }
    }
    return false;
}

}  // namespace

Stepped orient_outward(RepairMesh mesh) {
    StepReport report(RepairStep::orient_outward);
    const std::vector<StoredComponent> components =
        find_stored_components(mesh.positions, mesh.triangles);
    std::vector<ComponentBox> boxes;
    boxes.reserve(components.size());
    for (const StoredComponent& component : components) boxes.push_back(box_of(mesh, component));
    std::vector<std::size_t> turned;
    for (std::size_t i = 0; i < components.size(); ++i) {
        const StoredComponent& component = components[i];
        if (!component.balanced || !(component.volume < -component.volume_error)) continue;
        std::size_t around = 0;
        for (std::size_t j = 0; j < components.size(); ++j) {
            if (j == i || !components[j].balanced || !contains(boxes[j], boxes[i])) continue;
            if (is_within(mesh, components[j], component)) ++around;
        }
        if (around % 2 == 0) turned.push_back(i);  // an odd number: a cavity, already wound as one
    }
    for (const std::size_t i : turned) {
        for (const std::uint32_t t : components[i].triangles) {
            turn(mesh, t);
            report.reversed.push_back(mesh.triangle_origin[t].source);
        }
    }
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
