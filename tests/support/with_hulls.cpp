// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include "exact/predicates.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/small_hull.h"

#include "cdprep/format/hulls.h"

namespace cdprep::test {
namespace {

using format::HullFacet;
using Face = std::array<std::uint32_t, 3>;

/// Facets with their neighbours; groups are not known yet.
std::vector<HullFacet> facets_of(const std::vector<Face>& triangles) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> left_of;
    std::vector<HullFacet> facets;
    for (const Face& face : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            left_of[{face[i], face[(i + 1) % 3]}] = static_cast<std::uint32_t>(facets.size());
        }
        facets.push_back({face, {}, 0});
    }
    for (HullFacet& facet : facets) {
        for (std::size_t i = 0; i < 3; ++i) {
            facet.across[i] = left_of.at({facet.point[(i + 1) % 3], facet.point[i]});
        }
    }
    return facets;
}

/// The triangles of a hull, those of a coplanar face behind each other, and how many each has.
struct Grouped {
    std::vector<Face> triangles;
    std::vector<std::uint32_t> sizes;
};

Grouped by_plane(const SmallHull& hull) {
    const std::vector<HullFacet> facets = facets_of(hull.triangles());
    const auto& p = hull.points();
    Grouped result;
    std::vector<bool> is_taken(facets.size());
    for (std::uint32_t first = 0; first < facets.size(); ++first) {
        if (is_taken[first]) continue;
        is_taken[first] = true;
        std::vector<std::uint32_t> found = {first};
        const Face& plane = facets[first].point;
        for (std::size_t i = 0; i < found.size(); ++i) {
            result.triangles.push_back(facets[found[i]].point);
            for (const std::uint32_t next : facets[found[i]].across) {
                const Face& face = facets[next].point;
                const bool is_in = std::all_of(face.begin(), face.end(), [&](std::uint32_t v) {
                    return orient3d(p[plane[0]], p[plane[1]], p[plane[2]], p[v]) == 0;
                });
                if (!is_in || is_taken[next]) continue;
                is_taken[next] = true;
                found.push_back(next);
            }
        }
        result.sizes.push_back(static_cast<std::uint32_t>(found.size()));
    }
    return result;
}

/// The sections of hulls, one hull after the other.
struct Sections {
    std::vector<format::Hull> hulls;
    std::vector<format::HullBlock> blocks;
    std::vector<std::uint32_t> vertices;
    std::vector<HullFacet> facets;
    std::vector<format::HullGroup> groups;
    std::vector<std::uint32_t> neighbours;
    std::vector<std::uint32_t> starts;

    void add(format::HullScope scope, const SmallHull& hull) {
        const Grouped grouped = by_plane(hull);
        const ConvexPoints view = hull.view();
        format::Hull& at = add_empty(scope);
        at.dimension = 3;
        at.point_count = view.count;
        at.facet_count = static_cast<std::uint32_t>(grouped.triangles.size());
        at.group_count = static_cast<std::uint32_t>(grouped.sizes.size());
        at.neighbour_count = static_cast<std::uint32_t>(view.neighbours.size());
        at.start_count = format::kHullStarts;
        at.reach = view.reach;
        blocks.insert(blocks.end(), view.blocks.begin(), view.blocks.end());
        vertices.resize(blocks.size() * format::kHullLanes, format::kNoVertex);
        std::vector<HullFacet> made = facets_of(grouped.triangles);
        std::uint32_t first = 0;
        for (std::uint32_t g = 0; g < grouped.sizes.size(); first += grouped.sizes[g++]) {
            for (std::uint32_t f = 0; f < grouped.sizes[g]; ++f) made[first + f].group = g;
            groups.push_back({first, grouped.sizes[g]});
        }
        facets.insert(facets.end(), made.begin(), made.end());
        for (const auto list : {view.neighbour_begins, view.neighbours}) {
            neighbours.insert(neighbours.end(), list.begin(), list.end());
        }
        starts.insert(starts.end(), view.starts.begin(), view.starts.end());
    }
    format::Hull& add_empty(format::HullScope scope) {
        format::Hull hull{};
        hull.scope = scope;
        hull.dimension = -1;
        hull.first_block = static_cast<std::uint32_t>(blocks.size());
        hull.first_facet = static_cast<std::uint32_t>(facets.size());
        hull.first_group = static_cast<std::uint32_t>(groups.size());
        hull.first_neighbour = static_cast<std::uint32_t>(neighbours.size());
        hull.first_start = static_cast<std::uint32_t>(starts.size());
        return hulls.emplace_back(hull);
    }
};

}  // namespace

AlignedBytes with_hulls(const AlignedBytes& file) {
    const OpenModel open = open_tiny(AlignedBytes(file.span()));
    const BuilderInput input = builder_input(open.model);
    Sections made;
    if (input.positions.empty()) {
        made.add_empty(format::HullScope::whole);
    } else {
        const SmallHull hull(input.positions);
        if (hull.triangles().empty()) return AlignedBytes(file.span());
        made.add(format::HullScope::whole, hull);
        made.add(format::HullScope::component, hull);
    }
    const auto section = [](SectionId id, const auto& elements) {
        return as_section(id, std::span(elements));
    };
    return with_sections(
        file,
        {section(SectionId::hulls, made.hulls), section(SectionId::hull_blocks, made.blocks),
         section(SectionId::hull_vertices, made.vertices),
         section(SectionId::hull_facets, made.facets), section(SectionId::hull_groups, made.groups),
         section(SectionId::hull_neighbours, made.neighbours),
         section(SectionId::hull_starts, made.starts)});
}

}  // namespace cdprep::test
