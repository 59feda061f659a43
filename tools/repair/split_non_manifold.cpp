// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "mesh/around_edge.h"
#include "mesh/vectors.h"
#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

constexpr std::size_t kMostSplitPasses =
    64;  ///< over edges that pairs share; two suffice in practice

/// Pairs uses around the edge like brackets. Each opening use pairs with the next closing one
/// that no use in between takes.
void pair_around(const RepairMesh& mesh, std::span<const HalfEdge> uses,
                 std::vector<HalfEdge>& twins) {
    const AroundEdge around(mesh.positions, mesh.triangles, uses);
    std::vector<HalfEdge> open;
    const std::vector<HalfEdge> order = around.sorted(uses);
    for (int turn = 0; turn < 2; ++turn) {
        for (const HalfEdge h : order) {
            if (twins[h] != kNone) continue;
            if (around.opens(h)) {
                if (turn == 0) open.push_back(h);
            } else if (!open.empty()) {
                twins[h] = open.back();
                twins[open.back()] = h;
                open.pop_back();
            }
        }
    }
}

std::vector<HalfEdge> pair_all(const RepairMesh& mesh, const EdgeUses& edges) {
    std::vector<HalfEdge> twins = find_twins(mesh.triangles, edges);
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        if (edges.of(edge).size() > 2) pair_around(mesh, edges.of(edge), twins);
    }
    return twins;
}

/// Cuts the triangle of h at a vertex on h. The half that contains the start of h keeps the
/// numbers of the triangle and of h.
void cut_at(RepairMesh& mesh, std::vector<HalfEdge>& twins, HalfEdge h, std::uint32_t middle) {
    const HalfEdge next = next_in_triangle(h);
    const auto added = static_cast<HalfEdge>(mesh.triangles.size());
    Triangle half = mesh.triangles[h / 3];
    half.vertex[h % 3] = middle;
    mesh.triangles[h / 3].vertex[next % 3] = middle;
    mesh.triangle_origin[h / 3].step = RepairStep::split_non_manifold;
    mesh.triangles.push_back(half);
    mesh.triangle_origin.push_back(Origin(mesh.triangle_origin[h / 3]));
    // The new half has the far part of h, all of `next`, and the cut.
    const HalfEdge far = 3 * added + h % 3, far_next = 3 * added + next % 3;
    const HalfEdge far_cut = previous_in_triangle(far);
    twins.resize(twins.size() + 3, kNone);
    twins[far_next] = twins[next];
    if (twins[next] != kNone) twins[twins[next]] = far_next;
    twins[next] = far_cut;
    twins[far_cut] = next;
}

/// Cuts h and its twin in the middle. Returns false if the middle rounds to an end.
bool cut_in_middle(RepairMesh& mesh, std::vector<HalfEdge>& twins, HalfEdge h, StepReport& report) {
    const Double3 a = mesh.positions[start_of(mesh.triangles, h)];
    const Double3 b = mesh.positions[end_of(mesh.triangles, h)];
    const std::uint32_t middle = add_vertex(mesh, middle_of(a, b), report.step);
    if (mesh.positions[middle] == a || mesh.positions[middle] == b) {
        mesh.positions.pop_back();
        mesh.vertex_origin.pop_back();
        return false;
    }
    ++report.added_vertices;
    const HalfEdge other = twins[h];
    report.cut.push_back(mesh.triangle_origin[h / 3].source);
    cut_at(mesh, twins, h, middle);
    if (other == kNone) return true;
    report.cut.push_back(mesh.triangle_origin[other / 3].source);
    const auto far_h = static_cast<HalfEdge>(3 * (mesh.triangles.size() - 1) + h % 3);
    cut_at(mesh, twins, other, middle);
    const auto far_other = static_cast<HalfEdge>(3 * (mesh.triangles.size() - 1) + other % 3);
    twins[h] = far_other;
    twins[far_other] = h;
    twins[other] = far_h;
    twins[far_h] = other;
    return true;
}

/// Returns one half-edge for each pair or boundary among the uses, except the first.
std::vector<HalfEdge> all_but_first_pair(std::span<const HalfEdge> uses,
                                         const std::vector<HalfEdge>& twins) {
    std::vector<HalfEdge> rest;
    for (const HalfEdge h : uses) {
        if (twins[h] == kNone || h < twins[h]) rest.push_back(h);
    }
    if (!rest.empty()) rest.erase(rest.begin());
    return rest;
}

/// Cuts the edges that several pairs still share: all pairs but one get a vertex in the middle.
bool cut_shared_edges(RepairMesh& mesh, std::vector<HalfEdge>& twins, StepReport& report) {
    const EdgeUses edges = find_edge_uses(mesh.triangles, mesh.positions.size());
    const std::size_t old_count = mesh.triangles.size();
    std::vector<bool> touched(old_count, false);
    bool cut = false;
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        if (uses.size() == 1 || (uses.size() == 2 && twins[uses[0]] == uses[1])) continue;
        for (const HalfEdge h : all_but_first_pair(uses, twins)) {
            const HalfEdge other = twins[h];
            // A cut triangle has new half-edges: it waits for the next pass.
            if (touched[h / 3] ||
                (other != kNone && (other / 3 >= old_count || touched[other / 3]))) {
                cut = true;
                continue;
            }
            if (!cut_in_middle(mesh, twins, h, report)) continue;
            touched[h / 3] = true;
            if (other != kNone) touched[other / 3] = true;
            cut = true;
        }
    }
    return cut;
}

/// Cuts the later one of two triangles with the same corners from its middle.
void cut_twin_triangles(RepairMesh& mesh, StepReport& report) {
    struct Key {
        std::array<std::uint32_t, 3> corners;
        std::uint32_t triangle;
        auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& v = mesh.triangles[t].vertex;
        keys.push_back({{v[0], v[1], v[2]}, t});
        std::sort(keys.back().corners.begin(), keys.back().corners.end());
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (keys[i].corners != keys[i - 1].corners) continue;
        const std::uint32_t t = keys[i].triangle;
        const auto v = mesh.triangles[t].vertex;
        const Double3 &a = mesh.positions[v[0]], &b = mesh.positions[v[1]],
                      &c = mesh.positions[v[2]];
        const Double3 centre{a.x / 3 + b.x / 3 + c.x / 3, a.y / 3 + b.y / 3 + c.y / 3,
                             a.z / 3 + b.z / 3 + c.z / 3};
        const std::uint32_t middle = add_vertex(mesh, centre, report.step);
        ++report.added_vertices;
        report.cut.push_back(mesh.triangle_origin[t].source);
        mesh.triangle_origin[t].step = report.step;
        mesh.triangles[t] = {{v[0], v[1], middle}};
        mesh.triangles.push_back({{v[1], v[2], middle}});
        mesh.triangles.push_back({{v[2], v[0], middle}});
        mesh.triangle_origin.resize(mesh.triangles.size(), Origin(mesh.triangle_origin[t]));
    }
}

/// Returns whether every edge has one triangle, or two that `twins` joins. The two must not have
/// all corners in common.
bool are_edges_sound(const RepairMesh& mesh, const EdgeUses& edges,
                     const std::vector<HalfEdge>& twins) {
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        if (uses.size() == 1) continue;
        if (uses.size() > 2 || twins[uses[0]] != uses[1]) return false;
        if (apex_of(mesh.triangles, uses[0]) == apex_of(mesh.triangles, uses[1])) return false;
    }
    return true;
}

}  // namespace

Stepped split_non_manifold(RepairMesh mesh) {
    StepReport report(RepairStep::split_non_manifold);
    const EdgeUses edges = find_edge_uses(mesh.triangles, mesh.positions.size());
    std::vector<HalfEdge> twins = pair_all(mesh, edges);
    part_fans(mesh, twins, report.parted, report.step);
    // If no fan was split, the edges have not changed.
    if (report.parted.empty() && are_edges_sound(mesh, edges, twins))
        return {std::move(mesh), std::move(report)};
    for (std::size_t pass = 0; pass < kMostSplitPasses; ++pass) {
        if (!cut_shared_edges(mesh, twins, report)) break;
    }
    cut_twin_triangles(mesh, report);
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
