// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <optional>

#include "repair/mesh_meetings.h"
#include "repair/ray_along_x.h"
#include "repair/repair_steps.h"
#include "repair/stored_verdict.h"
#include "repair/test_points.h"

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

/// Returns the winding number of a component at p; nothing on its surface.
std::optional<int> number_at(const RepairMesh& mesh, const StoredComponent& component,
                             const Double3& p) {
    int winding = 0;
    for (const std::uint32_t t : component.triangles) {
        const auto& v = mesh.triangles[t].vertex;
        const WindingTerm term = winding_term_along_x(
            p, {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]});
        if (term.on_surface) return std::nullopt;
        winding += term.crossings;
    }
    return winding;
}

/// Returns whether the first point of `inner` off the surface of `outer` lies inside `outer`: at
/// an odd winding number. Nothing if all points tested lie on the surface.
std::optional<bool> is_within(const RepairMesh& mesh, const StoredComponent& outer,
                              const StoredComponent& inner) {
    const auto number =
        find_number_at_part(mesh.positions, mesh.triangles, inner.triangles,
                            [&](const Double3& p) { return number_at(mesh, outer, p); }, {});
    if (!number) return std::nullopt;
    return *number % 2 != 0;
}

/// Decides which components of negative volume are cavities.
class Cavities {
public:
    Cavities(const RepairMesh& mesh, const std::vector<StoredComponent>& components)
        : mesh_(mesh), components_(components) {
        for (const StoredComponent& component : components) {
            boxes_.push_back(box_of(mesh, component));
        }
    }

    /// Returns whether the component lies within an odd number of others. Nothing if it touches
    /// one of them at every point tested; then reports a refusal.
    std::optional<bool> is_cavity(std::size_t i, StepReport& report) const {
        bool is_odd = false;
        for (std::size_t j = 0; j < components_.size(); ++j) {
            if (j == i || !components_[j].balanced || !contains(boxes_[j], boxes_[i])) continue;
            const auto within = is_within(mesh_, components_[j], components_[i]);
            if (!within) {
                report.refused.push_back(refusal(components_[i], components_[j]));
                return std::nullopt;
            }
            is_odd = is_odd != *within;
        }
        return is_odd;
    }

private:
    [[nodiscard]] Refusal refusal(const StoredComponent& inner,
                                  const StoredComponent& outer) const {
        const std::uint32_t t = inner.triangles[0], u = outer.triangles[0];
        Refusal refusal;
        refusal.sentence = "the component of " + triangle_in_words(mesh_, t) + " touches that of " +
                           triangle_in_words(mesh_, u) +
                           " at every point that was tested, so it may be a cavity.";
        refusal.triangles = {mesh_.triangle_origin[t].source, mesh_.triangle_origin[u].source};
        refusal.position = mesh_.positions[mesh_.triangles[t].vertex[0]];
        return refusal;
    }

    const RepairMesh& mesh_;
    const std::vector<StoredComponent>& components_;
    std::vector<ComponentBox> boxes_;
};

}  // namespace

Stepped orient_outward(RepairMesh mesh) {
    StepReport report(RepairStep::orient_outward);
    const std::vector<StoredComponent> components =
        find_stored_components(mesh.positions, mesh.triangles);
    const Cavities cavities(mesh, components);
    std::vector<std::size_t> turned;
    for (std::size_t i = 0; i < components.size(); ++i) {
        const StoredComponent& component = components[i];
        if (!component.balanced || !(component.volume < -component.volume_error)) continue;
        const std::optional<bool> is_cavity = cavities.is_cavity(i, report);
        if (is_cavity && !*is_cavity) turned.push_back(i);  // a cavity is already wound as one
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
