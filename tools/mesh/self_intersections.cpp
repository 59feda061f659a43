// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/self_intersections.h"

#include <algorithm>

#include "mesh/degenerate.h"
#include "mesh/neighbour_meetings.h"
#include "mesh/triangle_meeting.h"
#include "mesh/vertex_stars.h"
#include "self_walk.h"

namespace cdprep::mesh {
namespace {

/// The triangles that have area, where others have none.
struct WithArea {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> number;  ///< in the mesh
};

WithArea with_area(const Mesh& mesh, const std::vector<std::uint64_t>& flat) {
    WithArea kept;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (((flat[i / 64] >> (i % 64)) & 1) != 0) continue;
        kept.triangles.push_back(mesh.triangles[i]);
        kept.number.push_back(i);
    }
    return kept;
}

Corners corners_of(const Mesh& mesh, std::uint32_t triangle) {
    const auto& v = mesh.triangles[triangle].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

/// Appends the meetings of triangles without a common vertex, in no order.
void find_meetings_apart(const Mesh& mesh, const WithArea* with_area,
                         ParallelFor parallel_for,
                         std::vector<TriangleMeeting>& all) {
    const std::vector<Triangle>& triangles = with_area ? with_area->triangles : mesh.triangles;
    const build::Bvh bvh = build::build_bvh(mesh.positions, triangles,
                                            {.parallel_for = parallel_for,
                                             .bounds = build::BvhBounds::aligned,
                                             .quality = build::Quality::fast});
    const SelfWalk walk(bvh, triangles, parallel_for);
    std::vector<std::vector<TriangleMeeting>> found(walk.part_count());
    const auto run = [&](std::size_t part) {
        Workspace workspace;
        std::vector<SelfPair> pairs;
        walk.run(part, workspace.storage(), pairs);
        const auto number = [&](std::uint32_t place) {
            return with_area ? with_area->number[bvh.order[place]] : bvh.order[place];
        };
        for (const SelfPair& pair : pairs) {
            const auto [a, b] = std::minmax({number(pair.a), number(pair.b)});
            const auto meeting = meeting_apart(corners_of(mesh, a), corners_of(mesh, b));
            if (meeting) found[part].push_back({a, b, *meeting});
        }
    };
    parallel_for(walk.part_count(), run);
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
}

}  // namespace

std::vector<TriangleMeeting> find_self_intersections(const Mesh& mesh,
                                                     ParallelFor parallel_for) {
    const std::vector<std::uint64_t> flat = find_degenerate(mesh, parallel_for);
    std::vector<TriangleMeeting> found =
        find_neighbour_meetings(mesh, VertexStars(mesh, flat), parallel_for);
    if (flat.empty()) {
        find_meetings_apart(mesh, nullptr, parallel_for, found);
    } else {
        const WithArea kept = with_area(mesh, flat);
        find_meetings_apart(mesh, &kept, parallel_for, found);
    }
    std::sort(found.begin(), found.end(), [](const TriangleMeeting& x, const TriangleMeeting& y) {
        return x.a != y.a ? x.a < y.a : x.b < y.b;
    });
    return found;
}

}  // namespace cdprep::mesh
