// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/surface_edges.h"

#include <algorithm>
#include <span>

#include "cdprep/exact/predicates.h"
#include "decompose/surface/flat_turn.h"
#include "mesh/degenerate.h"

namespace cdprep::convex {
namespace {

using mesh::HalfEdge;
using mesh::kNone;

/// Returns the kind that the uses of an edge imply, without positions. `convex` means "joined".
EdgeKind kind_by_uses(const mesh::Mesh& mesh, std::span<const HalfEdge> uses) {
    if (uses.size() == 1) return EdgeKind::border;
    if (uses.size() > 2) return EdgeKind::non_manifold;
    const std::span triangles(mesh.triangles);
    const bool same = mesh::start_of(triangles, uses[0]) == mesh::start_of(triangles, uses[1]);
    return same ? EdgeKind::inconsistent : EdgeKind::convex;
}

/// Returns the kind of an edge that joins two triangles with area.
EdgeKind kind_by_bend(const mesh::Mesh& mesh, HalfEdge h, HalfEdge twin) {
    const std::span triangles(mesh.triangles);
    const auto at = [&](std::uint32_t vertex) { return mesh.positions[vertex]; };
    const Double3 a = at(mesh::start_of(triangles, h)), b = at(mesh::end_of(triangles, h));
    const Double3 c = at(mesh::apex_of(triangles, h)), d = at(mesh::apex_of(triangles, twin));
    const int sign = exact::orient3d(a, b, c, d);
    if (sign != 0) return sign > 0 ? EdgeKind::convex : EdgeKind::reflex;
    const int axis = axis_of_turn(a, b, c);
    return flat_turn(axis, a, b, c) == flat_turn(axis, b, a, d) ? EdgeKind::flat : EdgeKind::fold;
}

}  // namespace

SurfaceEdges find_surface_edges(const mesh::Mesh& mesh, ParallelFor parallel_for) {
    const std::vector<std::uint64_t> flat = mesh::find_degenerate(mesh, parallel_for);
    const auto has_area = [&](HalfEdge h) {
        const std::uint32_t t = h / 3;
        return flat.empty() || ((flat[t / 64] >> (t % 64)) & 1) == 0;
    };
    const mesh::EdgeUses uses = mesh::find_edge_uses(mesh.triangles, mesh.positions.size());
    SurfaceEdges edges;
    edges.twin.assign(3 * mesh.triangles.size(), kNone);
    edges.kind.assign(3 * mesh.triangles.size(), EdgeKind::no_area);

    constexpr std::size_t kAtATime = 1 << 14;  // edges per task: changes no result
    const std::size_t parts = (uses.edge_count() + kAtATime - 1) / kAtATime;
    std::vector<std::array<std::size_t, kEdgeKinds>> counts(parts);
    const auto classify = [&](std::size_t part) {
        const std::size_t last = std::min((part + 1) * kAtATime, uses.edge_count());
        for (std::size_t e = part * kAtATime; e < last; ++e) {
            const std::span<const HalfEdge> use = uses.of(e);
            EdgeKind kind = kind_by_uses(mesh, use);
            if (kind == EdgeKind::convex) {
                const bool bends = has_area(use[0]) && has_area(use[1]);
                kind = bends ? kind_by_bend(mesh, use[0], use[1]) : EdgeKind::no_area;
            }
            for (const HalfEdge h : use) edges.kind[h] = kind;
            ++counts[part][static_cast<std::size_t>(kind)];
            if (is_barrier(kind)) continue;
            edges.twin[use[0]] = use[1];
            edges.twin[use[1]] = use[0];
        }
    };
    parallel_for(parts, classify);
    for (const auto& count : counts) {
        for (std::size_t i = 0; i < kEdgeKinds; ++i) edges.count[i] += count[i];
    }
    return edges;
}

}  // namespace cdprep::convex
