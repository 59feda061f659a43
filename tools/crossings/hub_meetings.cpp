// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/hub_meetings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "crossings/arc.h"
#include "crossings/seen_triangle.h"
#include "crossings/triangle_meeting.h"
#include "mesh/point_tree.h"

namespace cdprep::mesh {
namespace {

/// The least number of triangles of a hub. With 512 around each vertex a BVH takes about as
/// long.
constexpr std::size_t kHub = 512;
constexpr std::size_t kTrianglesPerTask = 4096;

Box box_of(const Corners& corners) {
    Box box;
    for (const Double3& p : corners) box.add(p);
    return box;
}

Double3 middle_of(const Box& box) {
    return {0.5 * box.lower.x + 0.5 * box.upper.x, 0.5 * box.lower.y + 0.5 * box.upper.y,
            0.5 * box.lower.z + 0.5 * box.upper.z};
}

/// Returns a ball around a box, with a margin for the rounding of a centre far from the origin.
Ball ball_around(const Box& box) {
    double far = 0;
    for (const Double3& p : {box.lower, box.upper}) {
        far = std::max({far, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    return {middle_of(box), 0.5 * box.diagonal() + 0x1p-46 * far};
}

Box widened(const Box& box, double by) {
    return {{box.lower.x - by, box.lower.y - by, box.lower.z - by},
            {box.upper.x + by, box.upper.y + by, box.upper.z + by}};
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
    return std::any_of(a.vertex.begin(), a.vertex.end(), [&b](std::uint32_t vertex) {
        return std::find(b.vertex.begin(), b.vertex.end(), vertex) != b.vertex.end();
    });
}

/// Balls in trees by size: the radii in one tree differ by a factor of at most 2.
class BallTrees {
public:
    explicit BallTrees(std::vector<Ball> balls) : balls_(std::move(balls)) {
        std::map<int, std::vector<std::uint32_t>> sizes;
        for (std::uint32_t i = 0; i < balls_.size(); ++i) {
            sizes[std::ilogb(balls_[i].radius)].push_back(i);
        }
        for (auto& [size, numbers] : sizes) {
            std::vector<Double3> centres;
            for (const std::uint32_t i : numbers) centres.push_back(balls_[i].centre);
            trees_.push_back(
                {std::ldexp(2.0, size), std::move(numbers), PointTree(std::move(centres))});
        }
    }

    /// Calls visit(number) for the balls in boxes of centres that enter(box, radius) accepts. No
    /// ball of the box has a larger radius.
    template <class Enter, class Visit>
    void visit(const Enter& enter, const Visit& visit) const {
        for (const Tree& tree : trees_) {
            tree.centres.visit([&](const Box& box) { return enter(box, tree.radius); },
                               [&](std::uint32_t at) { visit(tree.number[at]); });
        }
    }

    [[nodiscard]] const Ball& ball(std::uint32_t number) const {
        return balls_[number];
    }

private:
    struct Tree {
        double radius;
        std::vector<std::uint32_t> number;
        PointTree centres;
    };
    std::vector<Ball> balls_;
    std::vector<Tree> trees_;
};

/// A hub, and the triangles whose first hub it is.
struct HubStar {
    std::uint32_t vertex;
    std::vector<std::uint32_t> triangle;
    Box box;
    BallTrees arcs;  ///< by index in `triangle`
};

}  // namespace

Hubs::Hubs(const Mesh& mesh, const VertexStars& stars) {
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
        if (stars.around(i).size() >= kHub) hub_.push_back(i);
    }
    if (hub_.empty()) return;
    std::stable_sort(hub_.begin(), hub_.end(), [&stars](std::uint32_t a, std::uint32_t b) {
        return stars.around(a).size() > stars.around(b).size();
    });
    home_.assign(mesh.triangles.size(), kNowhere);
    for (std::uint32_t hub = 0; hub < hub_.size(); ++hub) {
        for (const std::uint32_t triangle : stars.around(hub_[hub])) {
            home_[triangle] = std::min(home_[triangle], hub);
        }
    }
}

/// The data that all jobs read.
class HubSearch {
public:
    HubSearch(const Mesh& mesh, std::span<const std::uint64_t> flat, const VertexStars& stars,
              const Hubs& hubs)
        : mesh_(mesh), flat_(flat), hubs_(hubs), boxes_({}) {
        std::vector<Ball> around;
        for (std::uint32_t hub = 0; hub < hubs.hub_.size(); ++hub) {
            stars_.push_back(star_of(hub, stars));
            around.push_back(ball_around(stars_.back().box));
        }
        boxes_ = BallTrees(std::move(around));
    }

    /// Tests one triangle against the triangles around hubs.
    void ask(std::uint32_t triangle, SearchTurn& turn) const {
        if (!flat_.empty() && ((flat_[triangle / 64] >> (triangle % 64)) & 1) != 0) return;
        const Box box = box_of(corners_of(mesh_, triangle));
        boxes_.visit(
            [&](const Box& centres, double radius) { return widened(centres, radius).meets(box); },
            [&](std::uint32_t hub) {
                turn.count(1);
                // Of two hubs, the first one finds the pairs with the triangles of the second.
                const bool is_asked = hub < hubs_.home_[triangle] && !is_around(triangle, hub);
                if (is_asked && stars_[hub].box.meets(box)) look(triangle, box, hub, turn);
            });
    }

private:
    [[nodiscard]] HubStar star_of(std::uint32_t hub, const VertexStars& stars) const {
        const std::uint32_t vertex = hubs_.hub_[hub];
        std::vector<std::uint32_t> triangles;
        std::vector<Ball> arcs;
        Box box;
        for (const std::uint32_t triangle : stars.around(vertex)) {
            if (hubs_.home_[triangle] != hub) continue;
            const auto& v = mesh_.triangles[triangle].vertex;
            const std::size_t at = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
            const Corners corners = corners_of(mesh_, triangle);
            triangles.push_back(triangle);
            arcs.push_back(arc_ball(corners[at], corners[(at + 1) % 3], corners[(at + 2) % 3]));
            for (const Double3& p : corners) box.add(p);
        }
        return {vertex, std::move(triangles), box, BallTrees(std::move(arcs))};
    }

    [[nodiscard]] bool is_around(std::uint32_t triangle, std::uint32_t hub) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        return std::find(v.begin(), v.end(), stars_[hub].vertex) != v.end();
    }

    /// Tests the hub's triangles that appear, from the hub, in the direction of this one.
    void look(std::uint32_t triangle, const Box& box, std::uint32_t hub, SearchTurn& turn) const {
        const HubStar& star = stars_[hub];
        const SeenTriangle seen(mesh_.positions[star.vertex], corners_of(mesh_, triangle));
        star.arcs.visit(
            [&](const Box& centres, double radius) {
                turn.count(1);
                return !seen.is_apart(middle_of(centres), 0.5 * centres.diagonal() + radius);
            },
            [&](std::uint32_t at) {
                const Ball& arc = star.arcs.ball(at);
                if (seen.is_apart(arc.centre, arc.radius)) return;
                ask_pair(triangle, box, star.triangle[at], turn);
            });
    }

    void ask_pair(std::uint32_t triangle, const Box& box, std::uint32_t other,
                  SearchTurn& turn) const {
        turn.count(1);
        if (share_a_vertex(mesh_.triangles[triangle], mesh_.triangles[other])) return;
        const auto [a, b] = std::minmax(triangle, other);
        if (!box.meets(box_of(corners_of(mesh_, other)))) return;
        const auto meeting = meeting_apart(corners_of(mesh_, a), corners_of(mesh_, b));
        if (meeting) turn.add({a, b, *meeting});
    }

    const Mesh& mesh_;
    std::span<const std::uint64_t> flat_;
    const Hubs& hubs_;
    std::vector<HubStar> stars_;
    BallTrees boxes_;  ///< around the boxes of stars_
};

namespace {

/// A range of triangles, tested one after the other.
class HubJob {
public:
    HubJob(const HubSearch& hubs, std::size_t first, std::size_t last)
        : hubs_(&hubs), next_(first), last_(last) {}

    [[nodiscard]] bool is_done() const {
        return next_ == last_;
    }

    void go_on(SearchTurn& turn) {
        while (!is_done() && !turn.is_over()) {
            hubs_->ask(static_cast<std::uint32_t>(next_++), turn);
        }
    }

private:
    const HubSearch* hubs_;
    std::size_t next_;
    std::size_t last_;
};

}  // namespace

void search_hub_meetings(const Mesh& mesh, std::span<const std::uint64_t> flat,
                         const VertexStars& stars, const Hubs& hubs, MeetingSearch& search) {
    if (hubs.empty()) return;
    const HubSearch all(mesh, flat, stars, hubs);
    const std::size_t triangles = mesh.triangles.size();
    std::vector<HubJob> jobs;
    for (std::size_t first = 0; first < triangles; first += kTrianglesPerTask) {
        jobs.emplace_back(all, first, std::min(triangles, first + kTrianglesPerTask));
    }
    search.run(jobs);
}

}  // namespace cdprep::mesh
