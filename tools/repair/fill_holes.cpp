// SPDX-License-Identifier: GPL-3.0-or-later
// Not asked for here, and costly to compile.
#define CGAL_HOLE_FILLING_DO_NOT_USE_CDT2
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <map>
#include <set>

#include "repair/mesh_meetings.h"
#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

using HoleKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::size_t kMostForCubic = 500;  ///< vertices; the full search of CGAL takes n^3 steps

Edge edge_of(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

/// A loop of vertices, in the order in which new triangles use its edges.
using Loop = std::vector<std::uint32_t>;

/// Returns the boundary loops; follows each boundary edge backwards, once.
std::vector<Loop> find_loops(const RepairMesh& mesh, const EdgeUses& edges) {
    std::map<std::uint32_t, std::uint32_t> before;  // end to start of a boundary half-edge
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        if (edges.of(edge).size() != 1) continue;
        const HalfEdge h = edges.of(edge)[0];
        before[end_of(mesh.triangles, h)] = start_of(mesh.triangles, h);
    }
    std::vector<Loop> loops;
    std::set<std::uint32_t> seen;
    for (const auto& [end, start] : before) {
        if (seen.contains(end)) continue;
        Loop loop;
        std::uint32_t vertex = end;
        while (seen.insert(vertex).second) {
            loop.push_back(vertex);
            const auto at = before.find(vertex);
            if (at == before.end()) break;
            vertex = at->second;
        }
        if (vertex == end && loop.size() >= 3) loops.push_back(std::move(loop));
    }
    return loops;
}

/// Returns the triangles that CGAL proposes, as indices into the loop; none if it fails.
std::vector<Triangle> propose(const RepairMesh& mesh, const Loop& loop) {
    std::vector<HoleKernel::Point_3> points;
    for (const std::uint32_t vertex : loop) {
        const Double3& p = mesh.positions[vertex];
        points.emplace_back(p.x, p.y, p.z);
    }
    std::vector<CGAL::Triple<int, int, int>> proposed;
    try {
        CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
            points, std::back_inserter(proposed),
            CGAL::parameters::do_not_use_cubic_algorithm(loop.size() > kMostForCubic));
    } catch (const std::exception&) {
        return {};  // the loop is then filled around its middle
    }
    std::vector<Triangle> triangles;
    for (const auto& t : proposed) {
        std::array<int, 3> place = {t.first, t.second, t.third};
        std::sort(place.begin(), place.end());
        triangles.push_back(
            {{static_cast<std::uint32_t>(place[0]), static_cast<std::uint32_t>(place[1]),
              static_cast<std::uint32_t>(place[2])}});
    }
    if (triangles.size() + 2 != loop.size()) return {};
    return triangles;
}

double diagonal_of(const RepairMesh& mesh, const Loop& loop) {
    Double3 low = mesh.positions[loop[0]], high = low;
    for (const std::uint32_t vertex : loop) {
        const Double3& p = mesh.positions[vertex];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
}

Double3 middle_of_loop(const RepairMesh& mesh, const Loop& loop) {
    Double3 sum{};
    const auto count = static_cast<double>(loop.size());
    for (const std::uint32_t vertex : loop) {
        const Double3& p = mesh.positions[vertex];
        sum = {sum.x + p.x / count, sum.y + p.y / count, sum.z + p.z / count};
    }
    return sum;
}

class HoleFilling {
public:
    HoleFilling(RepairMesh& mesh, StepReport& report) : mesh_(mesh), report_(report) {
        const EdgeUses edges = find_edge_uses(mesh.triangles, mesh.positions.size());
        loops_ = find_loops(mesh, edges);
        for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
            const HalfEdge h = edges.of(edge)[0];
            edges_.insert(edge_of(start_of(mesh.triangles, h), end_of(mesh.triangles, h)));
        }
        find_lone(edges);
    }

    void run(const HoleLimits& limits, const StopCheck& stop) {
        const double most = limits.diagonal;
        patch_of_.assign(mesh_.triangles.size(), kNone);
        for (std::uint32_t i = 0; i < loops_.size(); ++i) {
            if (is_stopped(stop)) return;
            const double diagonal = diagonal_of(mesh_, loops_[i]);
            if (diagonal <= most) {
                fill(i);
            } else {
                refuse(loops_[i], diagonal,
                       "has a bounding box of diagonal " + std::to_string(diagonal) +
                           "; the hole size allows " + std::to_string(most));
            }
        }
    }

    /// Removes patches that meet the surface or each other.
    void take_back(const SearchOptions& options) {
        std::map<std::uint32_t, TriangleMeeting> bad;
        search_meetings(mesh_, options, [&](std::span<const TriangleMeeting> some) {
            for (const TriangleMeeting& meeting : some) note(meeting, bad);
        });
        if (bad.empty()) return;
        for (const auto& [patch, meeting] : bad) {
            refuse(loops_[patch], diagonal_of(mesh_, loops_[patch]),
                   "stays open, because a patch would make " + triangle_in_words(mesh_, meeting.a) +
                       " and " + triangle_in_words(mesh_, meeting.b) + " meet");
            // Only the patch used the vertex in its middle.
            if (around_middle_.contains(patch)) --report_.added_vertices;
        }
        std::vector<bool> kept(mesh_.triangles.size(), true);
        for (std::size_t t = 0; t < kept.size(); ++t) {
            if (patch_of_[t] == kNone || !bad.contains(patch_of_[t])) continue;
            kept[t] = false;
            --report_.added_triangles;
        }
        keep_triangles(mesh_, kept);
        drop_unused_vertices(mesh_, report_.unused);
    }

private:
    /// Records the lowest meeting of each patch.
    void note(const TriangleMeeting& meeting, std::map<std::uint32_t, TriangleMeeting>& bad) const {
        // If two patches meet, the later one is removed.
        const std::uint32_t later = patch_of_[meeting.b];
        const std::uint32_t patch = later == kNone ? patch_of_[meeting.a] : later;
        if (patch == kNone) return;
        TriangleMeeting& first = bad.try_emplace(patch, meeting).first->second;
        if (std::tie(meeting.a, meeting.b) < std::tie(first.a, first.b)) first = meeting;
    }

    void find_lone(const EdgeUses& edges) {
        std::vector<std::uint8_t> boundary(mesh_.triangles.size(), 0);
        for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
            if (edges.of(edge).size() == 1) ++boundary[edges.of(edge)[0] / 3];
        }
        for (std::size_t t = 0; t < boundary.size(); ++t) {
            if (boundary[t] != 3) continue;
            std::array<std::uint32_t, 3> corners = mesh_.triangles[t].vertex;
            std::sort(corners.begin(), corners.end());
            lone_.insert(corners);
        }
    }

    void fill(std::uint32_t number) {
        const Loop& loop = loops_[number];
        const std::vector<Triangle> proposed = propose(mesh_, loop);
        if (proposed.empty() || !take_edges(loop, proposed)) {
            fill_around_middle(number);
            return;
        }
        for (const Triangle& t : proposed) {
            add({{loop[t.vertex[0]], loop[t.vertex[1]], loop[t.vertex[2]]}}, number);
        }
    }

    /// Returns whether every diagonal is a new edge, and if so adds the diagonals to the edges.
    bool take_edges(const Loop& loop, const std::vector<Triangle>& proposed) {
        std::set<Edge> diagonals;
        for (const Triangle& t : proposed) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t.vertex[k], b = t.vertex[(k + 1) % 3];
                const auto [low, high] = edge_of(a, b);
                if (high == low + 1 || (low == 0 && high + 1 == loop.size())) continue;
                diagonals.insert(edge_of(loop[a], loop[b]));
            }
        }
        if (diagonals.empty()) return !is_lone(loop);
        for (const Edge& edge : diagonals) {
            if (edges_.contains(edge)) return false;
        }
        edges_.insert(diagonals.begin(), diagonals.end());
        return true;
    }

    /// Returns whether the loop consists of the edges of one triangle: a patch would cover it.
    [[nodiscard]] bool is_lone(const Loop& loop) const {
        std::array<std::uint32_t, 3> corners = {loop[0], loop[1], loop[2]};
        std::sort(corners.begin(), corners.end());
        return lone_.contains(corners);
    }

    void fill_around_middle(std::uint32_t number) {
        const Loop& loop = loops_[number];
        const std::uint32_t middle = add_vertex(mesh_, middle_of_loop(mesh_, loop), report_.step);
        ++report_.added_vertices;
        around_middle_.insert(number);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            add({{loop[i], loop[(i + 1) % loop.size()], middle}}, number);
        }
    }

    void add(const Triangle& triangle, std::uint32_t patch) {
        mesh_.triangles.push_back(triangle);
        mesh_.triangle_origin.push_back({kNone, report_.step});
        patch_of_.push_back(patch);
        ++report_.added_triangles;
    }

    void refuse(const Loop& loop, double measure, const std::string& why) {
        Refusal refusal;
        for (const std::uint32_t vertex : loop) {
            refusal.vertices.push_back(mesh_.vertex_origin[vertex].source);
        }
        const std::uint32_t first = refusal.vertices[0];
        refusal.sentence = "the loop of " + std::to_string(loop.size()) + " edges at vertex " +
                           (first == kNone ? "(new)" : std::to_string(first)) + " " + why + ".";
        refusal.position = mesh_.positions[loop[0]];
        refusal.measure = measure;
        report_.refused.push_back(std::move(refusal));
    }

    RepairMesh& mesh_;
    StepReport& report_;
    std::vector<Loop> loops_;
    std::set<Edge> edges_;
    std::set<std::array<std::uint32_t, 3>> lone_;  ///< triangles of three boundary edges
    std::set<std::uint32_t> around_middle_;        ///< loops filled around a new vertex
    std::vector<std::uint32_t> patch_of_;          ///< by triangle: the loop it fills, or kNone
};

}  // namespace

Stepped fill_holes(RepairMesh mesh, const HoleLimits& limits, const SearchOptions& search) {
    StepReport report(RepairStep::fill_holes);
    const bool may_cross =
        limits.crossing == Crossing::resolved_later || has_meetings(mesh, search);
    HoleFilling filling(mesh, report);
    filling.run(limits, search.stop);
    // If triangles meet already, a patch that meets one makes nothing worse.
    if (!may_cross && report.added_triangles > 0) {
        filling.take_back(search);
    }
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
