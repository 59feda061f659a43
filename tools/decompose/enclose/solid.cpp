// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/solid.h"

#include <algorithm>
#include <cmath>

#include "cdprep/exact/winding.h"
#include "mesh/component_numbers.h"
#include "mesh/nesting.h"
#include "mesh/topology.h"

namespace cdprep::convex {
namespace {

constexpr std::uint32_t kNoBody = std::numeric_limits<std::uint32_t>::max();
constexpr double kSlack = 1e-12;  ///< of the largest coordinate: some thousand roundings

/// Returns the host of each component: the component whose cavity it is, or itself. An inverted
/// component belongs to the upright one of least volume around it.
std::vector<std::uint32_t> find_hosts(const mesh::Mesh& mesh,
                                      const mesh::ComponentNumbers& components,
                                      const std::vector<format::Component>& facts) {
    std::vector<std::uint32_t> host(components.count);
    std::vector<bool> balanced(components.count);
    for (std::uint32_t i = 0; i < components.count; ++i) {
        host[i] = i;
        balanced[i] = (facts[i].flags & format::component_balanced) != 0;
    }
    for (const mesh::Nested& nested : mesh::find_nested(mesh, components, balanced)) {
        const double outer = facts[nested.outer].signed_volume;
        if (facts[nested.inner].signed_volume >= 0 || outer <= 0) continue;
        std::uint32_t& chosen = host[nested.inner];
        if (chosen == nested.inner || outer < facts[chosen].signed_volume) chosen = nested.outer;
    }
    return host;
}

}  // namespace

Solid::Solid(const mesh::Mesh& mesh, Reference reference, ParallelFor parallel_for)
    : tree_(mesh.positions, mesh.triangles, parallel_for), body_of_(mesh.triangles.size()) {
    const mesh::ComponentNumbers components = mesh::number_components(mesh);
    const std::vector<format::Component> facts = mesh::find_topology(mesh).components;
    const std::vector<std::uint32_t> host = find_hosts(mesh, components, facts);
    std::vector<std::uint32_t> body(components.count, kNoBody);
    for (std::uint32_t i = 0; i < components.count; ++i) {
        if (host[i] != i) continue;
        body[i] = body_count_++;
        const bool balanced = (facts[i].flags & format::component_balanced) != 0;
        balanced_.push_back(balanced && reference == Reference::solid);
        encloses_ = encloses_ || balanced_.back();
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        body_of_[i] = body[host[components.of_vertex[mesh.triangles[i].vertex[0]]]];
    }
    const mesh::Box& box = tree_.box();
    slack_ =
        kSlack * std::max({std::fabs(box.lower.x), std::fabs(box.lower.y), std::fabs(box.lower.z),
                           std::fabs(box.upper.x), std::fabs(box.upper.y), std::fabs(box.upper.z)});
}

void Solid::count_around(const Double3& p, std::vector<Around>& around) const {
    const Double3 before = exact::before_along_x(p, diagonal());
    tree_.along_x(p, [&](std::uint32_t triangle) {
        const std::uint32_t body = body_of_[triangle];
        if (!balanced_[body]) return;
        const WindingTerm term = exact::winding_term(before, p, tree_.corners(triangle));
        auto at = std::find_if(around.begin(), around.end(),
                               [body](const Around& a) { return a.body == body; });
        if (at == around.end()) at = around.insert(around.end(), {body, 0, false});
        at->winding += term.crossings;
        at->on_surface = at->on_surface || term.on_surface;
    });
}

bool Solid::includes(const Double3& p) const {
    if (!encloses_ || !tree_.box().contains(p)) return false;
    std::vector<Around> around;
    count_around(p, around);
    return std::any_of(around.begin(), around.end(),
                       [](const Around& a) { return a.winding != 0 || a.on_surface; });
}

std::vector<std::uint32_t> Solid::bodies_around(const Double3& p) const {
    std::vector<std::uint32_t> bodies;
    if (!encloses_ || !tree_.box().contains(p)) return bodies;
    std::vector<Around> around;
    count_around(p, around);
    for (const Around& a : around) {
        if (a.winding != 0 || a.on_surface) bodies.push_back(a.body);
    }
    std::sort(bodies.begin(), bodies.end());
    return bodies;
}

}  // namespace cdprep::convex
