// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/self_intersections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/self_walk.h"
#include "cdprep/format/limits.h"
#include "crossings/fan.h"
#include "crossings/hub_meetings.h"
#include "crossings/meeting_search.h"
#include "crossings/star_pairs.h"
#include "crossings/triangle_meeting.h"
#include "mesh/degenerate.h"
#include "mesh/vertex_stars.h"

namespace cdprep::mesh {
namespace {

constexpr std::size_t kVerticesPerTask = 4096;

/// Up to this many triangles around a vertex, all pairs are tested without a search.
constexpr std::size_t kFewAround = 64;

/// The corners that two triangles share, as indices into each.
struct SharedCorners {
    std::array<std::size_t, 3> in_a;
    std::array<std::size_t, 3> in_b;
    std::size_t count = 0;
};

SharedCorners shared_corners(const Triangle& a, const Triangle& b) {
    SharedCorners shared{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (a.vertex[i] != b.vertex[j]) continue;
            shared.in_a[shared.count] = i;
            shared.in_b[shared.count++] = j;
        }
    }
    return shared;
}

Corners corners_from(const Mesh& mesh, const Triangle& triangle, std::size_t first) {
    const auto at = [&](std::size_t i) { return mesh.positions[triangle.vertex[(first + i) % 3]]; };
    return {at(0), at(1), at(2)};
}

/// Returns the corner that is neither of the two.
std::size_t third(std::size_t i, std::size_t j) {
    return 3 - i - j;
}

std::optional<Meeting> meeting_of(const Mesh& mesh, const Triangle& a, const Triangle& b,
                                  const SharedCorners& shared) {
    switch (shared.count) {
        case 1:
            return meeting_at_corner(corners_from(mesh, a, shared.in_a[0]),
                                     corners_from(mesh, b, shared.in_b[0]));
        case 2:
            return meeting_at_edge(
                corners_from(mesh, a, third(shared.in_a[0], shared.in_a[1]) + 1),
                corners_from(mesh, b, third(shared.in_b[0], shared.in_b[1]) + 1));
        default:
            return Meeting::duplicate;
    }
}

/// The data that all jobs read.
struct Neighbourhood {
    const Mesh& mesh;
    const VertexStars& stars;
    std::vector<std::uint8_t> is_flat;  ///< by vertex: its triangles lie side by side
};

/// Tests pairs around some vertices whose triangles may not lie side by side.
class NeighbourJob {
public:
    NeighbourJob(const Neighbourhood& around, std::size_t first, std::size_t last)
        : around_(&around), vertex_(first), last_(last) {}

    [[nodiscard]] bool is_done() const {
        return vertex_ == last_;
    }

    void go_on(SearchTurn& turn) {
        while (!is_done() && !turn.is_over()) {
            if (around_->is_flat[vertex_] != 0 || !ask_some(turn)) ++vertex_;
        }
    }

private:
    /// Returns false when all pairs around the vertex are tested.
    bool ask_some(SearchTurn& turn) {
        const auto vertex = static_cast<std::uint32_t>(vertex_);
        const auto star = around_->stars.around(vertex);
        const auto visit = [&](std::uint32_t a, std::uint32_t b) { ask(vertex, a, b, turn); };
        if (star.size() > kFewAround) return ask_large(vertex, star, visit, turn);
        for (std::size_t i = 0; i < star.size(); ++i) {
            for (std::size_t j = i + 1; j < star.size(); ++j) visit(star[i], star[j]);
        }
        return false;
    }

    bool ask_large(std::uint32_t vertex, std::span<const std::uint32_t> star,
                   const StarPairs::Visit& visit, SearchTurn& turn) {
        if (!pairs_) pairs_.emplace(around_->mesh, vertex, star);
        turn.count(1);
        if (pairs_->advance(visit)) return true;
        pairs_.reset();
        return false;
    }

    void ask(std::uint32_t vertex, std::uint32_t a, std::uint32_t b, SearchTurn& turn) const {
        const Triangle& in_a = around_->mesh.triangles[a];
        const Triangle& in_b = around_->mesh.triangles[b];
        turn.count(1);
        const SharedCorners shared = shared_corners(in_a, in_b);
        for (std::size_t i = 0; i < shared.count; ++i) {
            const std::uint32_t other = in_a.vertex[shared.in_a[i]];
            // Decided at that vertex, or tested there.
            if (around_->is_flat[other] != 0 || other < vertex) return;
        }
        const auto meeting = meeting_of(around_->mesh, in_a, in_b, shared);
        if (meeting) turn.add({a, b, *meeting});
    }

    const Neighbourhood* around_;
    std::size_t vertex_;
    std::size_t last_;
    std::optional<StarPairs> pairs_;  ///< of `vertex_`, if it has many triangles
};

/// Searches the pairs of triangles with common vertices that also meet elsewhere. The triangles
/// of the stars must have area.
void search_neighbour_meetings(const Mesh& mesh, const VertexStars& stars, MeetingSearch& search) {
    const std::size_t vertices = mesh.positions.size();
    const std::size_t tasks = (vertices + kVerticesPerTask - 1) / kVerticesPerTask;
    const auto end_of_task = [&](std::size_t task) {
        return std::min(vertices, (task + 1) * kVerticesPerTask);
    };
    Neighbourhood around{mesh, stars, std::vector<std::uint8_t>(vertices)};
    const auto look = [&](std::size_t task) {
        if (is_stopped(search.stop())) return;
        Fan fan;
        for (std::size_t i = task * kVerticesPerTask; i < end_of_task(task); ++i) {
            const auto vertex = static_cast<std::uint32_t>(i);
            around.is_flat[i] = fan.lies_side_by_side(mesh, vertex, stars.around(i)) ? 1 : 0;
        }
    };
    search.parallel_for()(tasks, look);
    std::vector<NeighbourJob> jobs;
    for (std::size_t task = 0; task < tasks; ++task) {
        jobs.emplace_back(around, task * kVerticesPerTask, end_of_task(task));
    }
    search.run(jobs);
}

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
