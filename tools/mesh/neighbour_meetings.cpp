// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/neighbour_meetings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/fan.h"
#include "mesh/star_pairs.h"
#include "mesh/triangle_meeting.h"

namespace cdprep::mesh {
namespace {

constexpr std::size_t kVerticesPerTask = 4096;

/// Of fewer triangles around a vertex all pairs are asked before those to ask are found.
constexpr std::size_t kFewAround = 64;

/// The corners that two triangles share: places in either.
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

/// The corner that is neither of two.
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

/// Asks pairs around vertices that are not known to lie side by side.
class Asker {
public:
    Asker(const Mesh& mesh, const VertexStars& stars, const std::vector<std::uint8_t>& is_flat)
        : mesh_(mesh), stars_(stars), is_flat_(is_flat) {}

    void ask_around(std::uint32_t vertex, std::vector<TriangleMeeting>& found) const {
        const auto star = stars_.around(vertex);
        if (star.size() > kFewAround) {
            for_star_pairs(mesh_, vertex, star,
                           [&](std::uint32_t a, std::uint32_t b) { ask(vertex, a, b, found); });
            return;
        }
        for (std::size_t i = 0; i < star.size(); ++i) {
            for (std::size_t j = i + 1; j < star.size(); ++j) {
                ask(vertex, star[i], star[j], found);
            }
        }
    }

private:
    void ask(std::uint32_t vertex, std::uint32_t a, std::uint32_t b,
             std::vector<TriangleMeeting>& found) const {
        const Triangle& in_a = mesh_.triangles[a];
        const Triangle& in_b = mesh_.triangles[b];
        const SharedCorners shared = shared_corners(in_a, in_b);
        for (std::size_t i = 0; i < shared.count; ++i) {
            const std::uint32_t other = in_a.vertex[shared.in_a[i]];
            // Answered there, or asked there.
            if (is_flat_[other] != 0 || other < vertex) return;
        }
        const auto meeting = meeting_of(mesh_, in_a, in_b, shared);
        if (meeting) found.push_back({a, b, *meeting});
    }

    const Mesh& mesh_;
    const VertexStars& stars_;
    const std::vector<std::uint8_t>& is_flat_;
};

}  // namespace

std::vector<TriangleMeeting> find_neighbour_meetings(const Mesh& mesh, const VertexStars& stars,
                                                     ParallelFor parallel_for) {
    const std::size_t vertices = mesh.positions.size();
    const std::size_t tasks = (vertices + kVerticesPerTask - 1) / kVerticesPerTask;
    std::vector<std::uint8_t> is_flat(vertices);
    const auto for_vertices = [&](std::size_t task, const auto& body) {
        const std::size_t last = std::min(vertices, (task + 1) * kVerticesPerTask);
        for (std::size_t i = task * kVerticesPerTask; i < last; ++i) {
            body(static_cast<std::uint32_t>(i));
        }
    };
    const auto look = [&](std::size_t task) {
        Fan fan;
        for_vertices(task, [&](std::uint32_t vertex) {
            is_flat[vertex] = fan.lies_side_by_side(mesh, vertex, stars.around(vertex)) ? 1 : 0;
        });
    };
    parallel_for(tasks, look);
    std::vector<std::vector<TriangleMeeting>> found(tasks);
    const Asker asker(mesh, stars, is_flat);
    const auto ask = [&](std::size_t task) {
        for_vertices(task, [&](std::uint32_t vertex) {
            if (is_flat[vertex] == 0) asker.ask_around(vertex, found[task]);
        });
    };
    parallel_for(tasks, ask);
    std::vector<TriangleMeeting> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace cdprep::mesh
