// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

/// Returns the vertices at the ends of edges with one triangle.
std::vector<std::uint32_t> find_boundary_vertices(const RepairMesh& mesh) {
    const EdgeUses edges = find_edge_uses(mesh.triangles, mesh.positions.size());
    std::vector<std::uint32_t> vertices;
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        if (edges.of(edge).size() != 1) continue;
        vertices.push_back(start_of(mesh.triangles, edges.of(edge)[0]));
        vertices.push_back(end_of(mesh.triangles, edges.of(edge)[0]));
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace

Stepped stitch_seams(RepairMesh mesh, double width) {
    StepReport report(RepairStep::stitch_seams);
    const std::vector<std::uint32_t> boundary = find_boundary_vertices(mesh);
    // Welds a mesh of boundary vertices only: each point is a triangle that repeats one corner.
    RepairMesh points;
    for (const std::uint32_t vertex : boundary) {
        const auto number = static_cast<std::uint32_t>(points.positions.size());
        points.positions.push_back(mesh.positions[vertex]);
        points.vertex_origin.push_back(mesh.vertex_origin[vertex]);
        points.triangles.push_back({{number, number, number}});
        points.triangle_origin.push_back({number, std::nullopt});
    }
    Stepped welded = weld_vertices(std::move(points), width);
    report.merged = std::move(welded.report.merged);
    report.moved = welded.report.moved;
    if (report.merged.empty()) return {std::move(mesh), std::move(report)};

    std::vector<std::uint32_t> stands(welded.mesh.positions.size(), kNone);
    std::vector<std::uint32_t> renamed(mesh.positions.size());
    std::iota(renamed.begin(), renamed.end(), 0U);
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        std::uint32_t& stand = stands[welded.mesh.triangles[i].vertex[0]];
        if (stand == kNone) stand = boundary[i];
        renamed[boundary[i]] = stand;
    }
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = renamed[vertex];
    }
    std::vector<std::uint32_t> merged_away;
    drop_unused_vertices(mesh, merged_away);
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
