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

Corners corners_of(const Mesh& mesh, std::uint32_t triangle) {
    const auto& v = mesh.triangles[triangle].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

/// Appends the meetings of triangles without a common vertex, in no order.
void find_meetings_apart(const Mesh& mesh, const std::vector<std::uint64_t>& flat,
                         ParallelFor parallel_for,
                         std::vector<TriangleMeeting>& all) {
    const build::Bvh bvh = build::build_bvh(mesh.positions, mesh.triangles,
                                            {.parallel_for = parallel_for,
                                             .bounds = build::BvhBounds::aligned,
                                             .quality = build::Quality::fast});
    const SelfWalk walk(bvh, mesh.triangles, flat, parallel_for);
    std::vector<std::vector<TriangleMeeting>> found(walk.part_count());
    const auto run = [&](std::size_t part) {
        Workspace workspace;
        std::vector<SelfPair> pairs;
        walk.run(part, workspace.storage(), pairs);
        for (const SelfPair& pair : pairs) {
            const auto [a, b] = std::minmax({bvh.order[pair.a], bvh.order[pair.b]});
            const Corners in_a = corners_of(mesh, a), in_b = corners_of(mesh, b);
            const auto meeting =
                pair.certain ? meeting_across(in_a, in_b) : meeting_apart(in_a, in_b);
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
    find_meetings_apart(mesh, flat, parallel_for, found);
    std::sort(found.begin(), found.end(), [](const TriangleMeeting& x, const TriangleMeeting& y) {
        return x.a != y.a ? x.a < y.a : x.b < y.b;
    });
    return found;
}

}  // namespace cdprep::mesh
