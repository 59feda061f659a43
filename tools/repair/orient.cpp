// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

/// Returns for each half-edge the other one of an edge of two triangles, in either direction.
std::vector<HalfEdge> find_neighbours(const RepairMesh& mesh) {
    const EdgeUses edges = find_edge_uses(mesh.triangles, mesh.positions.size());
    std::vector<HalfEdge> across(3 * mesh.triangles.size(), kNone);
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        if (uses.size() != 2) continue;
        across[uses[0]] = uses[1];
        across[uses[1]] = uses[0];
    }
    return across;
}

bool are_all_wound_alike(const RepairMesh& mesh, const std::vector<HalfEdge>& across) {
    for (HalfEdge h = 0; h < across.size(); ++h) {
        if (across[h] == kNone || across[h] < h) continue;
        if (start_of(mesh.triangles, h) == start_of(mesh.triangles, across[h])) return false;
    }
    return true;
}

enum class Winding : std::uint8_t { unknown, kept, turned };

/// Winds the patch of `seed` breadth first, and returns its triangles.
std::vector<std::uint32_t> wind_patch(const RepairMesh& mesh, const std::vector<HalfEdge>& across,
                                      std::uint32_t seed, std::vector<Winding>& winding) {
    std::vector<std::uint32_t> patch = {seed};
    winding[seed] = Winding::kept;
    for (std::size_t i = 0; i < patch.size(); ++i) {
        for (HalfEdge h = 3 * patch[i]; h < 3 * patch[i] + 3; ++h) {
            if (across[h] == kNone) continue;
            const std::uint32_t other = across[h] / 3;
            if (winding[other] != Winding::unknown) continue;
            const bool alike = start_of(mesh.triangles, h) != start_of(mesh.triangles, across[h]);
            const bool turned = (winding[patch[i]] == Winding::turned) == alike;
            winding[other] = turned ? Winding::turned : Winding::kept;
            patch.push_back(other);
        }
    }
    return patch;
}

}  // namespace

Stepped orient(RepairMesh mesh) {
    StepReport report(RepairStep::orient);
    const std::vector<HalfEdge> across = find_neighbours(mesh);
    if (are_all_wound_alike(mesh, across)) return {std::move(mesh), std::move(report)};
    std::vector<Winding> winding(mesh.triangles.size(), Winding::unknown);
    std::vector<std::uint32_t> turned;
    for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (winding[seed] != Winding::unknown) continue;
        const std::vector<std::uint32_t> patch = wind_patch(mesh, across, seed, winding);
        const auto turns = std::count_if(patch.begin(), patch.end(), [&](std::uint32_t t) {
            return winding[t] == Winding::turned;
        });
        const bool others = 2 * static_cast<std::size_t>(turns) > patch.size();
        for (const std::uint32_t t : patch) {
            if ((winding[t] == Winding::turned) != others) turned.push_back(t);
        }
    }
    std::sort(turned.begin(), turned.end());
    for (const std::uint32_t t : turned) {
        turn(mesh, t);
        report.reversed.push_back(mesh.triangle_origin[t].source);
    }
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
