// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/boundary.h"

#include <algorithm>
#include <numeric>

#include "cdprep/advanced/disjoint_sets.h"
#include "mesh/close_groups.h"
#include "mesh/half_edges.h"
#include "validate/defects/source_places.h"

namespace cdprep::mesh {
namespace {

/// Numbers the end vertices of the edges in mesh order.
void list_ends(const Mesh& mesh, Boundary& boundary) {
    std::vector<std::uint32_t>& end = boundary.end_of_vertex;
    end.assign(mesh.positions.size(), kNone);
    for (const FlawedEdge& edge : boundary.edge) end[edge.from] = end[edge.to] = 0;
    for (std::uint32_t vertex = 0; vertex < end.size(); ++vertex) {
        if (end[vertex] == kNone) continue;
        end[vertex] = static_cast<std::uint32_t>(boundary.vertex.size());
        boundary.vertex.push_back(vertex);
    }
}

void list_edges_at_ends(Boundary& boundary) {
    const auto for_each_end = [&boundary](const auto& visit) {
        for (std::uint32_t i = 0; i < boundary.edge.size(); ++i) {
            visit(boundary.end_at(boundary.edge[i].from), i);
            visit(boundary.end_at(boundary.edge[i].to), i);
        }
    };
    std::vector<std::uint32_t>& first = boundary.first_at;
    first.assign(boundary.vertex.size() + 1, 0);
    for_each_end([&first](std::uint32_t end, std::uint32_t) { ++first[end + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    boundary.edges_at.resize(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for_each_end([&](std::uint32_t end, std::uint32_t i) { boundary.edges_at[next[end]++] = i; });
}

/// Walks along loops and lists their vertices in order.
class LoopWalk {
public:
    explicit LoopWalk(const Boundary& boundary) : boundary_(boundary) {
        used_.resize(boundary.edge.size());
        leading_seen_.resize(boundary.vertex.size());
        seen_.resize(boundary.vertex.size());
        by_loop_.resize(boundary.edge.size());
        std::iota(by_loop_.begin(), by_loop_.end(), 0U);
        std::stable_sort(by_loop_.begin(), by_loop_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return boundary.loop_of[a] < boundary.loop_of[b];
        });
    }

    /// Walks the edges of a loop, each followed by a connected one where possible. Calls
    /// visit(edge, vertex) with the vertex at which the walk enters the edge. Call this for
    /// loops in ascending order.
    template <class Visit>
    void walk(std::uint32_t loop, Visit visit) {
        for (; next_ < by_loop_.size() && boundary_.loop_of[by_loop_[next_]] == loop; ++next_) {
            std::uint32_t i = by_loop_[next_];
            std::uint32_t vertex = boundary_.edge[i].from;
            for (; i != kNone && !used_[i]; i = unused_at(vertex)) {
                used_[i] = true;
                visit(i, vertex);
                const FlawedEdge& edge = boundary_.edge[i];
                vertex = vertex == edge.from ? edge.to : edge.from;
            }
        }
    }

private:
    /// Returns the lowest unused edge at the vertex; edges that begin there come first.
    std::uint32_t unused_at(std::uint32_t vertex) {
        const std::uint32_t end = boundary_.end_at(vertex);
        const std::uint32_t leading = next_of(
            end, leading_seen_[end], [&](const FlawedEdge& edge) { return edge.from == vertex; });
        if (leading != kNone) return leading;
        return next_of(end, seen_[end], [](const FlawedEdge&) { return true; });
    }

    /// Returns the lowest unused edge of a kind at an end. The first `seen` edges of the end do
    /// not qualify and never will: no edge is examined twice.
    template <class OfKind>
    std::uint32_t next_of(std::uint32_t end, std::uint32_t& seen, OfKind of_kind) const {
        const std::span<const std::uint32_t> edges = boundary_.edges_of(end);
        for (; seen < edges.size(); ++seen) {
            if (!used_[edges[seen]] && of_kind(boundary_.edge[edges[seen]])) return edges[seen];
        }
        return kNone;
    }

    const Boundary& boundary_;
    std::vector<bool> used_;
    std::vector<std::uint32_t> leading_seen_;  ///< by end; see next_of()
    std::vector<std::uint32_t> seen_;
    std::vector<std::uint32_t> by_loop_;
    std::size_t next_ = 0;
};

}  // namespace

Boundary find_boundary(const Mesh& mesh, std::vector<FlawedEdge> edges) {
    Boundary boundary;
    boundary.edge = std::move(edges);
    if (boundary.edge.empty()) return boundary;
    std::sort(boundary.edge.begin(), boundary.edge.end(), comes_before);
    list_ends(mesh, boundary);
    list_edges_at_ends(boundary);
    build::DisjointSets sets(boundary.vertex.size());
    for (const FlawedEdge& edge : boundary.edge) {
        sets.unite(boundary.end_at(edge.from), boundary.end_at(edge.to));
    }
    std::vector<std::uint32_t> loop_of_root(boundary.vertex.size(), kNone);
    for (std::uint32_t i = 0; i < boundary.edge.size(); ++i) {
        const FlawedEdge& edge = boundary.edge[i];
        std::uint32_t& loop = loop_of_root[sets.root_of(boundary.end_at(edge.from))];
        if (loop == kNone) {
            loop = static_cast<std::uint32_t>(boundary.loop.size());
            boundary.loop.push_back({i, 0, {}});
        }
        boundary.loop_of.push_back(loop);
        ++boundary.loop[loop].edges;
        boundary.loop[loop].box.add(mesh.positions[edge.from]);
        boundary.loop[loop].box.add(mesh.positions[edge.to]);
    }
    return boundary;
}

void list_boundary(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                   FindingList& findings) {
    const std::vector<Double3>& position = sound.mesh.positions;
    for (const FlawedEdge& edge : boundary.edge) {
        findings.add(Rule::boundary_edge, [&] {
            return place_of_edge(soup, sound, edge,
                                 distance_between(position[edge.from], position[edge.to]));
        });
    }
    if (boundary.loop.empty()) return;
    LoopWalk walk(boundary);
    for (std::uint32_t i = 0; i < boundary.loop.size(); ++i) {
        findings.add(Rule::boundary_loop, [&] {
            Place place;
            place.position = position[boundary.edge[boundary.loop[i].first_edge].from];
            place.measure = boundary.loop[i].box.diagonal();
            walk.walk(i, [&](std::uint32_t edge, std::uint32_t vertex) {
                if (place.vertices.size() == kMaxPlaceNumbers) return;
                const std::uint32_t triangle = boundary.edge[edge].triangle;
                place.vertices.push_back(source_corner(soup, sound, triangle, vertex));
                place.triangles.push_back(sound.source_triangle[triangle]);
            });
            std::sort(place.triangles.begin(), place.triangles.end());
            place.triangles.erase(std::unique(place.triangles.begin(), place.triangles.end()),
                                  place.triangles.end());
            return place;
        });
    }
}

}  // namespace cdprep::mesh
