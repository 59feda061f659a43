// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "cdprep/advanced/disjoint_sets.h"
#include "cdprep/advanced/mesh_arrays.h"
#include "cdprep/format/float_environment.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::Triangle;

/// One use of an edge, stored with its lower vertex.
struct EdgeUse {
    std::uint32_t upper;  ///< the higher vertex
    std::int32_t sign;    ///< 1 from lower to upper, -1 back
};

/// All uses of edges; those with lower vertex v are in [first[v], first[v + 1]). There may be more
/// than 2^32.
struct EdgeUses {
    std::vector<std::size_t> first;
    std::vector<EdgeUse> use;
};

template <class Visit>
void for_each_edge(std::span<const Triangle> triangles, Visit visit) {
    for (const Triangle& triangle : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = triangle.vertex[i];
            const std::uint32_t to = triangle.vertex[(i + 1) % 3];
            if (from < to) visit(from, EdgeUse{to, 1});
            if (to < from) visit(to, EdgeUse{from, -1});
        }
    }
}

EdgeUses collect_edges(std::size_t vertex_count, std::span<const Triangle> triangles) {
    EdgeUses edges;
    // first[v + 1] is where the next use of vertex v goes: in the end, where those of v + 1 begin.
    edges.first.assign(vertex_count + 2, 0);
    for_each_edge(triangles, [&](std::size_t lower, EdgeUse) { ++edges.first[lower + 2]; });
    std::partial_sum(edges.first.begin(), edges.first.end(), edges.first.begin());
    assert(edges.first.back() <= 3 * triangles.size());
    edges.use.resize(edges.first.back());
    for_each_edge(triangles, [&](std::size_t lower, EdgeUse use) {
        edges.use[edges.first[lower + 1]++] = use;
    });
    return edges;
}

/// Returns whether all edges of one lower vertex cancel.
bool edges_cancel(std::span<EdgeUse> uses) {
    std::sort(uses.begin(), uses.end(),
              [](const EdgeUse& a, const EdgeUse& b) { return a.upper < b.upper; });
    for (std::size_t i = 0; i < uses.size();) {
        std::int32_t balance = 0;
        const std::uint32_t upper = uses[i].upper;
        for (; i < uses.size() && uses[i].upper == upper; ++i) balance += uses[i].sign;
        if (balance != 0) return false;
    }
    return true;
}

/// Returns six times the volume between a triangle and the point o.
double signed_volume_6(const Double3& a, const Double3& b, const Double3& c, const Double3& o) {
    const Double3 u{a.x - o.x, a.y - o.y, a.z - o.z};
    const Double3 v{b.x - o.x, b.y - o.y, b.z - o.z};
    const Double3 w{c.x - o.x, c.y - o.y, c.z - o.z};
    return u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) +
           u.z * (v.x * w.y - v.y * w.x);
}

double finite(double value) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    return std::isnan(value) ? 0 : std::clamp(value, -kLargest, kLargest);
}

}  // namespace

ComponentNumbers number_components(std::size_t vertex_count, std::span<const Triangle> triangles) {
    DisjointSets sets(vertex_count);
    for (const Triangle& triangle : triangles) {
        sets.unite(triangle.vertex[0], triangle.vertex[1]);
        sets.unite(triangle.vertex[0], triangle.vertex[2]);
    }
    constexpr std::uint32_t kNone = TreeOrder::kUnused;
    ComponentNumbers numbers;
    numbers.of_vertex.assign(vertex_count, kNone);
    for (const Triangle& triangle : triangles) {
        std::uint32_t& number = numbers.of_vertex[sets.root_of(triangle.vertex[0])];
        if (number == kNone) number = static_cast<std::uint32_t>(numbers.count++);
        for (const std::uint32_t vertex : triangle.vertex) numbers.of_vertex[vertex] = number;
    }
    return numbers;
}

Topology find_topology(std::span<const Double3> positions, std::span<const Triangle> triangles) {
    const format::FloatEnvironment environment;
    const ComponentNumbers components = number_components(positions.size(), triangles);
    const std::vector<std::uint32_t>& number = components.of_vertex;
    Topology topology;
    topology.components.assign(components.count, {0, 0, format::component_balanced, 0, 0});
    topology.balanced = true;

    EdgeUses edges = collect_edges(positions.size(), triangles);
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) {
        const std::size_t first = edges.first[vertex];
        if (edges_cancel(std::span(edges.use).subspan(first, edges.first[vertex + 1] - first))) {
            continue;
        }
        topology.balanced = false;
        topology.components[number[vertex]].flags = 0;
    }
    for (const Triangle& triangle : triangles) {
        format::Component& component = topology.components[number[triangle.vertex[0]]];
        if (component.triangle_count++ == 0) component.vertex = triangle.vertex[0];
        if ((component.flags & format::component_balanced) == 0) continue;
        const auto [a, b, c] = triangle.vertex;
        component.signed_volume +=  // six times, until the end: whole numbers stay exact
            signed_volume_6(positions[a], positions[b], positions[c], positions[component.vertex]);
    }
    for (format::Component& component : topology.components) {
        component.signed_volume = finite(component.signed_volume / 6);
    }
    return topology;
}

}  // namespace cdprep::build
