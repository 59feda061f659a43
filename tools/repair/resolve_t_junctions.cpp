// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <map>

#include "cdprep/exact/triangles.h"
#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

constexpr int kMostCutPasses = 16;  ///< a pass cuts each triangle along one edge

using HandledBox = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const std::uint32_t*>;

double along(const Double3& a, const Double3& b, const Double3& p) {
    return (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y) + (p.z - a.z) * (b.z - a.z);
}

bool is_between(const Double3& a, const Double3& b, const Double3& p) {
    const auto lies = [](double low, double high, double x) {
        return std::min(low, high) <= x && x <= std::max(low, high);
    };
    return p != a && p != b && lies(a.x, b.x, p.x) && lies(a.y, b.y, p.y) && lies(a.z, b.z, p.z);
}

class TJunctions {
public:
    TJunctions(RepairMesh& mesh, double width, StepReport& report)
        : mesh_(mesh), width_(width), report_(report) {}

    /// Cuts each triangle along at most one edge. Returns false if there is nothing to cut.
    bool run_pass() {
        find_boundary();
        std::map<HalfEdge, std::vector<std::uint32_t>> cuts = find_cuts();
        std::vector<bool> touched(mesh_.triangles.size(), false);
        bool any = false;
        for (auto& [half_edge, vertices] : cuts) {
            if (touched[half_edge / 3]) continue;
            touched[half_edge / 3] = true;
            any = cut(half_edge, vertices) || any;
        }
        return any;
    }

private:
    void find_boundary() {
        edges_.clear();
        vertices_.clear();
        const EdgeUses uses = find_edge_uses(mesh_.triangles, mesh_.positions.size());
        for (std::size_t edge = 0; edge < uses.edge_count(); ++edge) {
            if (uses.of(edge).size() != 1) continue;
            edges_.push_back(uses.of(edge)[0]);
            vertices_.push_back(start_of(mesh_.triangles, edges_.back()));
            vertices_.push_back(end_of(mesh_.triangles, edges_.back()));
        }
        std::sort(vertices_.begin(), vertices_.end());
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    }

    [[nodiscard]] bool lies_on(std::uint32_t vertex, HalfEdge h) const {
        const auto& corners = mesh_.triangles[h / 3].vertex;
        if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) return false;
        const Double3& a = mesh_.positions[start_of(mesh_.triangles, h)];
        const Double3& b = mesh_.positions[end_of(mesh_.triangles, h)];
        const Double3& p = mesh_.positions[vertex];
        if (width_ == 0) return is_between(a, b, p) && exact::is_degenerate({a, b, p});
        const double at = along(a, b, p), whole = along(a, b, b);
        return at > 0 && at < whole && exact::point_triangle_distance(p, {a, b, b}).upper <= width_;
    }

    std::map<HalfEdge, std::vector<std::uint32_t>> find_cuts() {
        std::vector<HandledBox> of_edges, of_vertices;
        for (const HalfEdge& h : edges_) {
            const Double3& a = mesh_.positions[start_of(mesh_.triangles, h)];
            const Double3& b = mesh_.positions[end_of(mesh_.triangles, h)];
            std::array<double, 3> low = {std::min(a.x, b.x) - width_, std::min(a.y, b.y) - width_,
                                         std::min(a.z, b.z) - width_};
            std::array<double, 3> high = {std::max(a.x, b.x) + width_, std::max(a.y, b.y) + width_,
                                          std::max(a.z, b.z) + width_};
            of_edges.emplace_back(low.data(), high.data(), &h);
        }
        for (const std::uint32_t& vertex : vertices_) {
            const Double3& p = mesh_.positions[vertex];
            std::array<double, 3> place = {p.x, p.y, p.z};
            of_vertices.emplace_back(place.data(), place.data(), &vertex);
        }
        std::map<HalfEdge, std::vector<std::uint32_t>> cuts;
        CGAL::box_intersection_d(of_edges.begin(), of_edges.end(), of_vertices.begin(),
                                 of_vertices.end(),
                                 [&](const HandledBox& edge, const HandledBox& vertex) {
                                     if (lies_on(*vertex.handle(), *edge.handle())) {
                                         cuts[*edge.handle()].push_back(*vertex.handle());
                                     }
                                 });
        return cuts;
    }

    /// Splits the triangle into a fan from its apex to the vertices on its edge.
    bool cut(HalfEdge h, std::vector<std::uint32_t>& vertices) {
        const std::uint32_t t = h / 3;
        const std::uint32_t a = start_of(mesh_.triangles, h), b = end_of(mesh_.triangles, h);
        const std::uint32_t apex = apex_of(mesh_.triangles, h);
        const Double3 &from = mesh_.positions[a], &to = mesh_.positions[b];
        std::sort(vertices.begin(), vertices.end(), [&](std::uint32_t u, std::uint32_t v) {
            const double at_u = along(from, to, mesh_.positions[u]);
            const double at_v = along(from, to, mesh_.positions[v]);
            return at_u != at_v ? at_u < at_v : u < v;
        });
        for (const std::uint32_t vertex : vertices) {
            if (width_ > 0) {
                report_.moved = std::max(
                    report_.moved,
                    exact::point_triangle_distance(mesh_.positions[vertex], {from, to, to}).upper);
            }
        }
        vertices.push_back(b);
        mesh_.triangles[t] = {{a, vertices[0], apex}};
        mesh_.triangle_origin[t].step = report_.step;
        for (std::size_t i = 1; i < vertices.size(); ++i) {
            mesh_.triangles.push_back({{vertices[i - 1], vertices[i], apex}});
            mesh_.triangle_origin.push_back(Origin(mesh_.triangle_origin[t]));
        }
        report_.cut.push_back(mesh_.triangle_origin[t].source);
        return true;
    }

    RepairMesh& mesh_;
    double width_;
    StepReport& report_;
    std::vector<HalfEdge> edges_;          ///< boundary half-edges
    std::vector<std::uint32_t> vertices_;  ///< their ends
};

}  // namespace

Stepped resolve_t_junctions(RepairMesh mesh, double width) {
    StepReport report(RepairStep::resolve_t_junctions);
    TJunctions junctions(mesh, width, report);
    for (int pass = 0; pass < kMostCutPasses && junctions.run_pass(); ++pass) {
    }
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
