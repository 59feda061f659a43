// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/hull_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "cdprep/advanced/convex_points.h"

namespace cdprep::convex {
namespace {

using format::kHullLanes;

Double3 reach_of(std::span<const Double3> points) {
    Double3 reach = {};
    for (const Double3& p : points) {
        reach = {std::max(reach.x, std::fabs(p.x)), std::max(reach.y, std::fabs(p.y)),
                 std::max(reach.z, std::fabs(p.z))};
    }
    return reach;
}

std::vector<format::HullFacet> facets_of(const ConvexHull& hull) {
    std::vector<format::HullFacet> facets;
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> left_of;
    std::uint32_t group = 0;
    for (std::uint32_t f = 0; f < hull.facets.size(); ++f) {
        if (f == hull.groups[group + 1]) ++group;
        const auto& point = hull.facets[f];
        facets.push_back({point, {}, group});
        for (std::size_t i = 0; i < 3; ++i) left_of[{point[i], point[(i + 1) % 3]}] = f;
    }
    for (format::HullFacet& facet : facets) {
        for (std::size_t i = 0; i < 3; ++i) {
            facet.across[i] = left_of.at({facet.point[(i + 1) % 3], facet.point[i]});
        }
    }
    return facets;
}

/// Returns the start of each point's neighbours, then the neighbours, ascending for each point.
std::vector<std::uint32_t> neighbour_words(const ConvexHull& hull) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& point : hull.facets) {
        for (std::size_t i = 0; i < 3; ++i) edges.push_back({point[i], point[(i + 1) % 3]});
    }
    std::sort(edges.begin(), edges.end());
    std::vector<std::uint32_t> words;
    std::size_t edge = 0;
    for (std::uint32_t p = 0; p <= hull.points.size(); ++p) {
        words.push_back(static_cast<std::uint32_t>(edge));
        while (edge < edges.size() && edges[edge][0] == p) ++edge;
    }
    for (const auto& [from, to] : edges) words.push_back(to);
    return words;
}

/// Returns the direction through the middle of a direction_cell().
Double3 cell_direction(std::uint32_t cell) {
    const std::uint32_t column = cell % kDirectionCells, row = cell / kDirectionCells;
    const std::uint32_t face = row / kDirectionCells;
    const auto middle = [](std::uint32_t place) { return (place + 0.5) * 2 / kDirectionCells - 1; };
    const std::size_t axis = face / 2;
    std::array<double, 3> d = {};
    d[axis] = face % 2 == 0 ? 1 : -1;
    d[(axis + 2) % 3] = middle(row % kDirectionCells);
    d[(axis + 1) % 3] = middle(column);
    return {d[0], d[1], d[2]};
}

std::uint32_t farthest_along(std::span<const Double3> points, const Double3& d) {
    std::uint32_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const double height = d.x * points[i].x + d.y * points[i].y + d.z * points[i].z;
        if (height > most) most = height, best = i;
    }
    return best;
}

template <class T>
std::uint32_t end_of(const std::vector<T>& section) {
    return static_cast<std::uint32_t>(section.size());
}

template <class T>
void append(std::vector<T>& section, const std::vector<T>& more) {
    section.insert(section.end(), more.begin(), more.end());
}

}  // namespace

void HullSections::add(format::HullScope scope, std::uint32_t number, const MeshHull& hull,
                       std::span<const std::uint32_t> source_vertex) {
    const ConvexHull& found = hull.hull;
    format::Hull entry{};
    entry.scope = scope;
    entry.number = number;
    entry.dimension = found.dimension;
    const bool is_exact = found.points.size() == found.numbers.size();
    entry.flags = is_exact ? format::hull_exact : 0U;
    entry.first_block = end_of(blocks);
    entry.point_count = end_of(found.points);
    entry.first_facet = end_of(facets);
    entry.facet_count = end_of(found.facets);
    entry.first_group = end_of(groups);
    entry.group_count = end_of(found.groups) - 1;
    entry.first_neighbour = end_of(neighbours);
    entry.first_start = end_of(starts);
    entry.distance = hull.distance;
    entry.reach = reach_of(found.points);
    append(blocks, hull_blocks(found.points));
    for (std::uint32_t i = 0; i < entry.point_count; ++i) {
        vertices.push_back(is_exact ? source_vertex[found.numbers[i]] : format::kNoVertex);
    }
    vertices.resize(blocks.size() * kHullLanes, format::kNoVertex);
    append(facets, facets_of(found));
    for (std::uint32_t g = 0; g < entry.group_count; ++g) {
        groups.push_back({found.groups[g], found.groups[g + 1] - found.groups[g]});
    }
    if (found.dimension >= 2 && entry.point_count >= kClimbFrom) {
        append(neighbours, neighbour_words(found));
        entry.neighbour_count = end_of(neighbours) - entry.first_neighbour - entry.point_count - 1;
        for (std::uint32_t cell = 0; cell < kDirectionStarts; ++cell) {
            starts.push_back(farthest_along(found.points, cell_direction(cell)));
        }
        entry.start_count = kDirectionStarts;
    }
    hulls.push_back(entry);
}

std::optional<HullSections> make_hull_sections(const mesh::Mesh& mesh,
                                               std::span<const format::Instance> instances,
                                               std::uint32_t max_vertices, ParallelFor run) {
    constexpr std::array<std::pair<HullScope, format::HullScope>, 3> kScopes = {
        {{HullScope::whole, format::HullScope::whole},
         {HullScope::component, format::HullScope::component},
         {HullScope::node, format::HullScope::instance}}};
    HullSections sections;
    for (const auto& [scope, stored] : kScopes) {
        const auto found = find_mesh_hulls(
            mesh, instances, {.scope = scope, .max_vertices = max_vertices, .parallel_for = run});
        if (!found) return std::nullopt;
        const bool is_part = scope != HullScope::whole;
        if (is_part && found->size() < 2) continue;
        if (scope == HullScope::component && found->size() > kMostComponentHulls) continue;
        for (std::uint32_t i = 0; i < found->size(); ++i) {
            sections.add(stored, i, (*found)[i], mesh.source_vertex);
        }
    }
    return sections;
}

void add_parts(HullSections& sections, std::span<const ApproximatePart> parts) {
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        sections.add(format::HullScope::part, i, {parts[i].hull, parts[i].error.upper}, {});
    }
}

}  // namespace cdprep::convex
