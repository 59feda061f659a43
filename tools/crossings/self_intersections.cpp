// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/self_intersections.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "cdprep/advanced/self_walk.h"
#include "cdprep/format/limits.h"
#include "crossings/hub_meetings.h"
#include "crossings/meeting_search.h"
#include "crossings/neighbour_meetings.h"
#include "crossings/triangle_meeting.h"
#include "mesh/degenerate.h"
#include "mesh/vertex_stars.h"

namespace cdprep::mesh {
namespace {

/// Returns smaller positions if the mesh's own are too large for a BVH; else none. The boxes
/// need not be exact, and shrinking loses nothing that they would show.
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

/// Triangles of a mesh, ascending, with their numbers in it.
struct SomeTriangles {
    std::vector<Triangle> triangle;
    std::vector<std::uint32_t> number;
};

/// Returns the triangles for the BVH; none if it takes all. Flat triangles stay out: those along
/// one line would have boxes around each other.
SomeTriangles for_hierarchy(const Mesh& mesh, const std::vector<std::uint64_t>& flat,
                            const Hubs& hubs) {
    SomeTriangles left;
    if (flat.empty() && hubs.empty()) return left;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const bool is_flat = !flat.empty() && ((flat[i / 64] >> (i % 64)) & 1) != 0;
        if (is_flat || hubs.has(i)) continue;
        left.triangle.push_back(mesh.triangles[i]);
        left.number.push_back(i);
    }
    return left;
}

/// A part of the walk of a BVH against itself.
class WalkJob {
public:
    WalkJob(const Mesh& mesh, const SelfWalk& walk, std::size_t part,
            const std::function<std::uint32_t(std::uint32_t)>& number)
        : mesh_(&mesh), walk_(&walk), number_(&number), rest_(walk.part(part)) {}

    [[nodiscard]] bool is_done() const {
        return rest_.empty();
    }

    void go_on(SearchTurn& turn) {
        Workspace workspace;
        walk_->run(
            rest_, workspace, [&](const SelfPair& pair) { ask(pair, turn); },
            [&](std::size_t work) { return turn.count(work); });
    }

private:
    void ask(const SelfPair& pair, SearchTurn& turn) const {
        const auto [a, b] = std::minmax({(*number_)(pair.a), (*number_)(pair.b)});
        const Corners in_a = corners_of(*mesh_, a), in_b = corners_of(*mesh_, b);
        turn.count(1);
        const auto meeting = pair.certain ? meeting_across(in_a, in_b) : meeting_apart(in_a, in_b);
        if (meeting) turn.add({a, b, *meeting});
    }

    const Mesh* mesh_;
    const SelfWalk* walk_;
    const std::function<std::uint32_t(std::uint32_t)>* number_;  ///< triangle at a BVH position
    SelfWalk::Rest rest_;
};

/// Searches the meetings of triangles without a common vertex and without a hub.
void search_meetings_apart(const Mesh& mesh, const std::vector<std::uint64_t>& flat,
                           const Hubs& hubs, MeetingSearch& search) {
    const std::vector<Double3> shrunk = shrunk_if_too_large(mesh);
    const bool has_all = flat.empty() && hubs.empty();
    const SomeTriangles left = for_hierarchy(mesh, flat, hubs);
    const std::vector<Triangle>& triangles = has_all ? mesh.triangles : left.triangle;
    const build::Bvh bvh = build::build_bvh(shrunk.empty() ? mesh.positions : shrunk, triangles,
                                            {.parallel_for = search.parallel_for(),
                                             .bounds = build::BvhBounds::aligned,
                                             .quality = build::Quality::fast});
    const std::function<std::uint32_t(std::uint32_t)> number = [&](std::uint32_t at) {
        return has_all ? bvh.order[at] : left.number[bvh.order[at]];
    };
    const SelfWalk walk(bvh, triangles, search.parallel_for());
    std::vector<WalkJob> jobs;
    for (std::size_t part = 0; part < walk.part_count(); ++part) {
        jobs.emplace_back(mesh, walk, part, number);
    }
    search.run(jobs);
}

}  // namespace

bool search_self_intersections(const Mesh& mesh, const SearchOptions& options,
                               const TakeMeetings& take) {
    MeetingSearch search(options, take);
    const std::vector<std::uint64_t> flat = find_degenerate(mesh, options.parallel_for);
    std::optional<VertexStars> stars(std::in_place, mesh, flat);
    search_neighbour_meetings(mesh, *stars, search);
    const Hubs hubs(mesh, *stars);
    search_hub_meetings(mesh, flat, *stars, hubs, search);
    stars.reset();  // before the BVH requires memory
    search_meetings_apart(mesh, flat, hubs, search);
    return search.is_complete();
}

std::vector<TriangleMeeting> find_self_intersections(const Mesh& mesh, ParallelFor parallel_for) {
    std::vector<TriangleMeeting> found;
    search_self_intersections(mesh, {.parallel_for = parallel_for},
                              [&](std::span<const TriangleMeeting> some) {
                                  found.insert(found.end(), some.begin(), some.end());
                              });
    std::sort(found.begin(), found.end(), [](const TriangleMeeting& x, const TriangleMeeting& y) {
        return x.a != y.a ? x.a < y.a : x.b < y.b;
    });
    return found;
}

}  // namespace cdprep::mesh
