// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include "mesh/close_groups.h"
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

/// Returns for each point of a welded mesh of points the lowest one that it joins.
std::vector<std::uint32_t> lowest_of_groups(const RepairMesh& welded) {
    std::vector<std::uint32_t> first(welded.positions.size(), kNone);
    std::vector<std::uint32_t> lowest;
    for (std::uint32_t i = 0; i < welded.triangles.size(); ++i) {
        std::uint32_t& at = first[welded.triangles[i].vertex[0]];
        if (at == kNone) at = i;
        lowest.push_back(at);
    }
    return lowest;
}

/// Refuses the groups in which a chain of close vertices moves one farther than the width: a finely
/// divided border would collapse. Their points become groups of one.
void refuse_wide_groups(const RepairMesh& mesh, const std::vector<std::uint32_t>& boundary,
                        double width, std::vector<std::uint32_t>& lowest, StepReport& report) {
    std::vector<double> moved(lowest.size(), 0);
    for (std::size_t i = 0; i < lowest.size(); ++i) {
        const double distance =
            distance_between(mesh.positions[boundary[i]], mesh.positions[boundary[lowest[i]]]);
        moved[lowest[i]] = std::max(moved[lowest[i]], distance);
    }
    std::map<std::uint32_t, Refusal> wide;
    for (std::uint32_t i = 0; i < lowest.size(); ++i) {
        if (moved[lowest[i]] <= width) continue;
        wide[lowest[i]].vertices.push_back(mesh.vertex_origin[boundary[i]].source);
        lowest[i] = i;
    }
    for (auto& [first, refusal] : wide) {
        const std::uint32_t source = refusal.vertices[0];
        refusal.sentence =
            "the chain of " + std::to_string(refusal.vertices.size()) + " vertices at vertex " +
            (source == kNone ? "(new)" : std::to_string(source)) + " would move by " +
            std::to_string(moved[first]) + "; the seam width allows " + std::to_string(width) + ".";
        refusal.position = mesh.positions[boundary[first]];
        refusal.measure = moved[first];
        report.refused.push_back(std::move(refusal));
    }
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
    const std::vector<std::uint32_t> joined = lowest_of_groups(welded.mesh);
    std::vector<std::uint32_t> lowest = joined;
    refuse_wide_groups(mesh, boundary, width, lowest, report);

    std::vector<std::uint32_t> renamed(mesh.positions.size());
    std::iota(renamed.begin(), renamed.end(), 0U);
    auto merged = welded.report.merged.begin();  // one for each point that is not the lowest
    for (std::uint32_t i = 0; i < boundary.size(); ++i) {
        renamed[boundary[i]] = boundary[lowest[i]];
        if (joined[i] == i) continue;
        if (lowest[i] != i) {
            report.merged.push_back(*merged);
            report.moved = std::max(report.moved, merged->distance);
        }
        ++merged;
    }
    if (report.merged.empty()) return {std::move(mesh), std::move(report)};
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = renamed[vertex];
    }
    std::vector<std::uint32_t> merged_away;
    drop_unused_vertices(mesh, merged_away);
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
