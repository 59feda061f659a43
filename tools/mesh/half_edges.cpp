// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/half_edges.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace cdprep::mesh {
namespace {

struct Use {
    std::uint32_t upper;
    HalfEdge half_edge;
    bool operator<(const Use& other) const {
        return upper != other.upper ? upper < other.upper : half_edge < other.half_edge;
    }
};

template <class Visit>
void for_each_use(std::span<const Triangle> triangles, Visit visit) {
    for (HalfEdge h = 0; h < 3 * triangles.size(); h += 3) {
        if (repeats_corner(triangles[h / 3])) continue;
        for (HalfEdge k = h; k < h + 3; ++k) {
            const auto [lower, upper] = std::minmax({start_of(triangles, k), end_of(triangles, k)});
            visit(lower, Use{upper, k});
        }
    }
}

}  // namespace

bool repeats_corner(const Triangle& triangle) noexcept {
    const auto& v = triangle.vertex;
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

EdgeUses find_edge_uses(std::span<const Triangle> triangles, std::size_t vertex_count) {
    if (triangles.size() > kMostMeshTriangles) {
        throw std::length_error("a mesh has " + std::to_string(triangles.size()) +
                                " triangles; at most " + std::to_string(kMostMeshTriangles) +
                                " are allowed");
    }
    std::vector<std::uint32_t> begin(vertex_count + 1, 0);
    for_each_use(triangles, [&](std::uint32_t lower, const Use&) { ++begin[lower + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Use> uses(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for_each_use(triangles,
                 [&](std::uint32_t lower, const Use& use) { uses[next[lower]++] = use; });

    EdgeUses edges;
    edges.use.reserve(uses.size());
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        const auto of_vertex =
            std::span(uses).subspan(begin[vertex], begin[vertex + 1] - begin[vertex]);
        std::sort(of_vertex.begin(), of_vertex.end());
        std::uint32_t upper = kNone;
        for (const Use& use : of_vertex) {
            if (use.upper != upper) {
                edges.first.push_back(static_cast<std::uint32_t>(edges.use.size()));
            }
            upper = use.upper;
            edges.use.push_back(use.half_edge);
        }
    }
    edges.first.push_back(static_cast<std::uint32_t>(edges.use.size()));
    return edges;
}

Groups::Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
}

std::uint32_t Groups::lowest(std::uint32_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
}

bool Groups::join(std::uint32_t a, std::uint32_t b) {
    a = lowest(a);
    b = lowest(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
}

std::vector<HalfEdge> find_twins(std::span<const Triangle> triangles, const EdgeUses& edges) {
    std::vector<HalfEdge> twins(3 * triangles.size(), kNone);
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        if (uses.size() != 2) continue;
        if (start_of(triangles, uses[0]) == start_of(triangles, uses[1])) continue;
        twins[uses[0]] = uses[1];
        twins[uses[1]] = uses[0];
    }
    return twins;
}

std::vector<std::uint32_t> find_fans(std::span<const HalfEdge> twins) {
    Groups corners(twins.size());
    for (HalfEdge h = 0; h < twins.size(); ++h) {
        if (twins[h] == kNone || twins[h] < h) continue;
        corners.join(h, next_in_triangle(twins[h]));
        corners.join(next_in_triangle(h), twins[h]);
    }
    std::vector<std::uint32_t> fans(twins.size());
    for (HalfEdge h = 0; h < twins.size(); ++h) fans[h] = corners.lowest(h);
    return fans;
}

}  // namespace cdprep::mesh
