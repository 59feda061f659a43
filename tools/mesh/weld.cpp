// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/weld.h"

#include "mesh/close_groups.h"
#include "mesh/half_edges.h"
#include "mesh/point_table.h"

namespace cdprep::mesh {
namespace {

std::vector<bool> used_vertices(const TriangleSoup& soup) {
    std::vector<bool> used(soup.positions.size(), false);
    for (const Triangle& triangle : soup.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) used[vertex] = true;
    }
    return used;
}

/// Renames every vertex to its representative. The representatives keep their order.
void keep_representatives(Mesh& mesh, const std::vector<std::uint32_t>& representative) {
    std::vector<std::uint32_t> renamed(mesh.positions.size(), kNone);
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
        if (representative[i] != i) continue;
        mesh.positions[next] = mesh.positions[i];
        mesh.source_vertex[next] = mesh.source_vertex[i];
        renamed[i] = next++;
    }
    mesh.positions.resize(next);
    mesh.source_vertex.resize(next);
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = renamed[representative[vertex]];
    }
}

/// Joins equal points and drops unused ones.
Mesh weld_equal(const TriangleSoup& soup, WeldReport& report) {
    const std::vector<bool> used = used_vertices(soup);
    std::vector<std::uint32_t> renamed(soup.positions.size(), kNone);
    Mesh mesh;
    mesh.single_precision = soup.single_precision;
    mesh.positions.reserve(soup.positions.size());
    PointTable table(soup.positions.size());
    for (std::uint32_t i = 0; i < soup.positions.size(); ++i) {
        if (!used[i]) {
            ++report.unused_vertices;
            continue;
        }
        const auto next = static_cast<std::uint32_t>(mesh.positions.size());
        renamed[i] = table.find_or_add(mesh.positions, soup.positions[i], next);
        if (renamed[i] != next) {
            ++report.merged_vertices;
            continue;
        }
        mesh.positions.push_back(soup.positions[i]);
        mesh.source_vertex.push_back(i);
    }
    mesh.triangles = soup.triangles;
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = renamed[vertex];
    }
    return mesh;
}

}  // namespace

Welded weld(const TriangleSoup& soup, const WeldOptions& options) {
    Welded welded;
    welded.mesh = weld_equal(soup, welded.report);
    if (options.distance > 0) {
        const std::size_t before = welded.mesh.positions.size();
        keep_representatives(welded.mesh, close_groups(welded.mesh.positions, options.distance));
        welded.report.merged_vertices += before - welded.mesh.positions.size();
    }
    for (const Triangle& triangle : welded.mesh.triangles) {
        if (repeats_corner(triangle)) ++welded.report.collapsed_triangles;
    }
    return welded;
}

}  // namespace cdprep::mesh
