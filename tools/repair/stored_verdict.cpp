// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/stored_verdict.h"

#include <algorithm>
#include <cmath>

namespace cdprep::mesh {
namespace {

using format::VerdictFacts;

Groups join_by_vertices(std::span<const Triangle> triangles, std::size_t vertex_count) {
    Groups groups(vertex_count);
    for (const Triangle& t : triangles) {
        groups.join(t.vertex[0], t.vertex[1]);
        groups.join(t.vertex[1], t.vertex[2]);
    }
    return groups;
}

std::int64_t balance_of(std::span<const Triangle> triangles, std::span<const HalfEdge> uses) {
    std::int64_t balance = 0;
    for (const HalfEdge h : uses) {
        balance += start_of(triangles, h) < end_of(triangles, h) ? 1 : -1;
    }
    return balance;
}

/// Counts the triangles that have the corners of an earlier one. Each is examined at the edge of
/// its two lower corners, where its apex is the highest corner.
std::uint64_t count_duplicates(std::span<const Triangle> triangles, const EdgeUses& edges) {
    std::uint64_t duplicates = 0;
    std::vector<std::uint32_t> apexes;
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        if (uses.size() == 1) continue;
        apexes.clear();
        for (const HalfEdge h : uses) {
            const std::uint32_t apex = apex_of(triangles, h);
            const std::uint32_t high = std::max(start_of(triangles, h), end_of(triangles, h));
            if (apex > high) apexes.push_back(apex);
        }
        std::sort(apexes.begin(), apexes.end());
        const auto distinct = std::unique(apexes.begin(), apexes.end());
        duplicates += static_cast<std::uint64_t>(apexes.end() - distinct);
    }
    return duplicates;
}

/// Counts vertices with several fans. Here a fan continues across every edge, whatever its
/// number of triangles.
std::uint64_t count_parted_vertices(std::span<const Triangle> triangles, const EdgeUses& edges,
                                    std::size_t vertex_count) {
    Groups corners(3 * triangles.size());
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        for (const HalfEdge h : uses.subspan(1)) {
            const bool alike = start_of(triangles, h) == start_of(triangles, uses[0]);
            const HalfEdge end = next_in_triangle(uses[0]);
            corners.join(h, alike ? uses[0] : end);
            corners.join(next_in_triangle(h), alike ? end : uses[0]);
        }
    }
    std::vector<std::uint32_t> fan(vertex_count, kNone);
    std::vector<bool> several(vertex_count, false);
    for (HalfEdge h = 0; h < 3 * triangles.size(); ++h) {
        if (repeats_corner(triangles[h / 3])) continue;
        const std::uint32_t vertex = start_of(triangles, h);
        const std::uint32_t lowest = corners.lowest(h);
        if (fan[vertex] == kNone) fan[vertex] = lowest;
        if (fan[vertex] != lowest) several[vertex] = true;
    }
    return static_cast<std::uint64_t>(std::count(several.begin(), several.end(), true));
}

std::uint32_t count_loops(std::span<const Triangle> triangles, const EdgeUses& edges,
                          std::size_t vertex_count) {
    Groups joined(vertex_count);
    std::vector<std::uint32_t> starts;
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        if (edges.of(edge).size() != 1) continue;
        const HalfEdge h = edges.of(edge)[0];
        joined.join(start_of(triangles, h), end_of(triangles, h));
        starts.push_back(start_of(triangles, h));
    }
    for (std::uint32_t& start : starts) start = joined.lowest(start);
    std::sort(starts.begin(), starts.end());
    return static_cast<std::uint32_t>(std::unique(starts.begin(), starts.end()) - starts.begin());
}

double area_of(const Double3& a, const Double3& b, const Double3& c) {
    const Double3 u{b.x - a.x, b.y - a.y, b.z - a.z};
    const Double3 v{c.x - a.x, c.y - a.y, c.z - a.z};
    return std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x) / 2;
}

/// Six times the volume between a triangle and o, and the sum of the absolute values of its
/// terms.
struct Volume6 {
    double volume, size;
};
Volume6 volume_6(const Double3& a, const Double3& b, const Double3& c, const Double3& o) {
    const Double3 u{a.x - o.x, a.y - o.y, a.z - o.z};
    const Double3 v{b.x - o.x, b.y - o.y, b.z - o.z};
    const Double3 w{c.x - o.x, c.y - o.y, c.z - o.z};
    const double volume = u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) +
                          u.z * (v.x * w.y - v.y * w.x);
    const auto part = [](double x, double y, double z) { return std::fabs(x * y * z); };
    return {volume, part(u.x, v.y, w.z) + part(u.x, v.z, w.y) + part(u.y, v.z, w.x) +
                        part(u.y, v.x, w.z) + part(u.z, v.x, w.y) + part(u.z, v.y, w.x)};
}

void measure_volume(StoredComponent& component, std::span<const Double3> positions,
                    std::span<const Triangle> triangles) {
    const Double3& o = positions[triangles[component.triangles[0]].vertex[0]];
    double size = 0;
    for (const std::uint32_t t : component.triangles) {
        const auto& v = triangles[t].vertex;
        const Volume6 part = volume_6(positions[v[0]], positions[v[1]], positions[v[2]], o);
        component.volume += part.volume;  // six times the volume: integers stay exact
        size += part.size / 6;
    }
    component.volume /= 6;
    // The error of each term is 8 u times its size, with u = 2^-53. The error of each addition
    // is at most u times the sum so far, which is at most the sum of all sizes.
    constexpr double kUnit = 1.1102230246251565e-16;
    component.volume_error = kUnit * (16 + static_cast<double>(component.triangles.size())) * size;
}

std::vector<StoredComponent> find_components(std::span<const Double3> positions,
                                             std::span<const Triangle> triangles,
                                             const EdgeUses& edges) {
    Groups joined = join_by_vertices(triangles, positions.size());
    std::vector<std::uint32_t> number(positions.size(), kNone);
    std::vector<StoredComponent> components;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        std::uint32_t& at = number[joined.lowest(triangles[t].vertex[0])];
        if (at == kNone) {
            at = static_cast<std::uint32_t>(components.size());
            components.emplace_back();
        }
        components[at].triangles.push_back(t);
    }
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        StoredComponent& of = components[number[joined.lowest(start_of(triangles, uses[0]))]];
        if (uses.size() == 1) of.closed = false;
        if (balance_of(triangles, uses) != 0) of.balanced = false;
    }
    for (StoredComponent& component : components) {
        if (component.balanced) measure_volume(component, positions, triangles);
    }
    return components;
}

}  // namespace

std::uint64_t count_unpaired_uses(std::span<const Double3> positions,
                                  std::span<const Triangle> triangles) {
    const EdgeUses edges = find_edge_uses(triangles, positions.size());
    std::uint64_t unpaired = 0;
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const std::int64_t balance = balance_of(triangles, edges.of(edge));
        unpaired += static_cast<std::uint64_t>(balance < 0 ? -balance : balance);
    }
    return unpaired;
}

std::vector<StoredComponent> find_stored_components(std::span<const Double3> positions,
                                                    std::span<const Triangle> triangles) {
    return find_components(positions, triangles, find_edge_uses(triangles, positions.size()));
}

StoredVerdict find_stored_verdict(std::span<const Double3> positions,
                                  std::span<const Triangle> triangles) {
    StoredVerdict found;
    const EdgeUses edges = find_edge_uses(triangles, positions.size());
    bool balanced = true;
    for (std::size_t edge = 0; edge < edges.edge_count(); ++edge) {
        const auto uses = edges.of(edge);
        const std::int64_t balance = balance_of(triangles, uses);
        found.boundary_edges += uses.size() == 1 ? 1 : 0;
        found.non_manifold_edges += uses.size() > 2 ? 1 : 0;
        found.inconsistent_edges += uses.size() == 2 && balance != 0 ? 1 : 0;
        balanced = balanced && balance == 0;
    }
    found.duplicate_triangles = count_duplicates(triangles, edges);
    found.non_manifold_vertices = count_parted_vertices(triangles, edges, positions.size());
    format::Verdict& verdict = found.verdict;
    std::vector<bool> used(positions.size(), false);
    for (const Triangle& t : triangles) {
        const auto& v = t.vertex;
        if (repeats_corner(t)) {
            ++found.repeated_corners;
            continue;
        }
        for (const std::uint32_t vertex : v) used[vertex] = true;
        verdict.area += area_of(positions[v[0]], positions[v[1]], positions[v[2]]);
    }
    const auto components = find_components(positions, triangles, edges);
    found.components = components.size();
    for (const StoredComponent& component : components) {
        found.closed_components += component.closed ? 1 : 0;
        if (balanced) verdict.volume += component.volume;
        if (component.balanced && component.volume < -component.volume_error) {
            ++found.inverted_components;
        }
    }
    const auto set = [&](VerdictFacts fact, bool is_true) {
        if (is_true) verdict.facts |= fact;
    };
    set(format::verdict_closed, found.boundary_edges == 0);
    set(format::verdict_two_manifold, found.non_manifold_edges + found.non_manifold_vertices +
                                              found.duplicate_triangles + found.repeated_corners ==
                                          0);
    set(format::verdict_oriented, found.inconsistent_edges == 0);
    set(format::verdict_balanced, balanced);
    set(format::verdict_inverted, balanced && verdict.volume < 0);
    verdict.triangle_count = static_cast<std::uint32_t>(triangles.size());
    verdict.boundary_loops = count_loops(triangles, edges, positions.size());
    verdict.euler = static_cast<std::int32_t>(
        std::count(used.begin(), used.end(), true) -
        static_cast<std::ptrdiff_t>(edges.edge_count()) +
        static_cast<std::ptrdiff_t>(triangles.size() - found.repeated_corners));
    verdict.genus = -1;
    return found;
}

bool is_worse(const StoredVerdict& after, const StoredVerdict& before) noexcept {
    const auto has = [](const StoredVerdict& found, VerdictFacts fact) {
        return (found.verdict.facts & fact) != 0;
    };
    if (has(before, format::verdict_balanced) && !has(after, format::verdict_balanced)) {
        return true;
    }
    for (const VerdictFacts fact :
         {format::verdict_two_manifold, format::verdict_oriented, format::verdict_closed}) {
        if (has(after, fact) != has(before, fact)) return has(before, fact);
    }
    return false;
}

}  // namespace cdprep::mesh
