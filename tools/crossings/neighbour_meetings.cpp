// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/neighbour_meetings.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "crossings/fan.h"
#include "crossings/star_pairs.h"
#include "crossings/triangle_meeting.h"

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

}  // namespace

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

}  // namespace cdprep::mesh
