// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/self_intersections.h"

#include <algorithm>
#include <cmath>

#include "cdprep/format/limits.h"
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

/// Positions that a hierarchy can be built over, where the mesh's own are too large: its
/// boxes need not be exact, and shrunk coordinates lose nothing that they would show.
std::vector<Double3> shrunk_if_too_large(const Mesh& mesh) {
    const auto too_large = [](const Double3& p) {
        return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) >
               0.5 * format::kMaxCoordinate;
    };
    if (std::none_of(mesh.positions.begin(), mesh.positions.end(), too_large)) return {};
    constexpr double kShrink = 0x1p-30;
    std::vector<Double3> shrunk = mesh.positions;
    for (Double3& p : shrunk) p = {p.x * kShrink, p.y * kShrink, p.z * kShrink};
    return shrunk;
}

/// Triangles of a mesh, ascending, and their numbers there.
struct SomeTriangles {
    std::vector<Triangle> triangle;
    std::vector<std::uint32_t> number;
};

/// Flat ones stay out of the hierarchy: those along one line would be around each other.
SomeTriangles without_flat(const Mesh& mesh, const std::vector<std::uint64_t>& flat) {
    SomeTriangles left;
    if (flat.empty()) return left;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (((flat[i / 64] >> (i % 64)) & 1) != 0) continue;
        left.triangle.push_back(mesh.triangles[i]);
        left.number.push_back(i);
    }
    return left;
}

/// Appends the meetings of triangles without a common vertex, in no order.
void find_meetings_apart(const Mesh& mesh, const std::vector<std::uint64_t>& flat,
                         ParallelFor parallel_for, std::vector<TriangleMeeting>& all) {
    const std::vector<Double3> shrunk = shrunk_if_too_large(mesh);
    const SomeTriangles left = without_flat(mesh, flat);
    const std::vector<Triangle>& triangles = flat.empty() ? mesh.triangles : left.triangle;
    const build::Bvh bvh = build::build_bvh(shrunk.empty() ? mesh.positions : shrunk, triangles,
                                            {.parallel_for = parallel_for,
                                             .bounds = build::BvhBounds::aligned,
                                             .quality = build::Quality::fast});
    const auto number = [&](std::uint32_t at) {
        return flat.empty() ? bvh.order[at] : left.number[bvh.order[at]];
    };
    const SelfWalk walk(bvh, triangles, parallel_for);
    std::vector<std::vector<TriangleMeeting>> found(walk.part_count());
    const auto run = [&](std::size_t part) {
        Workspace workspace;
        walk.run(part, workspace.storage(), [&](const SelfPair& pair) {
            const auto [a, b] = std::minmax({number(pair.a), number(pair.b)});
            const Corners in_a = corners_of(mesh, a), in_b = corners_of(mesh, b);
            const auto meeting =
                pair.certain ? meeting_across(in_a, in_b) : meeting_apart(in_a, in_b);
            if (meeting) found[part].push_back({a, b, *meeting});
        });
    };
    parallel_for(walk.part_count(), run);
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
}

}  // namespace

std::vector<TriangleMeeting> find_self_intersections(const Mesh& mesh, ParallelFor parallel_for) {
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
