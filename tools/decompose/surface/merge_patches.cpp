// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/patch_steps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <vector>

#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::HalfEdge;
using mesh::kNone;

// Shorter runs give more of them to merge in parallel, and more borders at which patches wait for
// the next step.
constexpr unsigned kFirstBits = 12;  ///< log2 of the triangles of a run in the first step
constexpr unsigned kMoreBits = 3;    ///< log2 of the growth of a run per step
// Weights in the rank of an edge, beside a weight of 1 for a face, or for a side if no tolerance
// is given. Chosen by trial for the fewest pieces.
constexpr double kFlatWeight = 0.4;  ///< of flatness, -1 to 1: below one face or side in all
constexpr double kSideWeight = 0.5;  ///< of a side at an edge not yet tried, with a tolerance

/// Returns -1 if the two triangles of an edge lie back to back, 1 if they lie in one plane.
double flatness(const PatchRules& rules, HalfEdge h) {
    const auto normal = [&](std::uint32_t triangle) {
        const Corners c = rules.solids.corners_of(triangle);
        return mesh::cross(mesh::minus(c[1], c[0]), mesh::minus(c[2], c[0]));
    };
    const Double3 a = normal(h / 3), b = normal(rules.edges.twin[h] / 3);
    const double lengths = std::sqrt(mesh::dot(a, a)) * std::sqrt(mesh::dot(b, b));
    const double cosine = mesh::dot(a, b) / lengths;
    return std::isfinite(cosine) ? std::clamp(cosine, -1.0, 1.0) : 1.0;
}

/// The edges to try, each once, by the first step in which both patches are in one part.
class Schedule {
public:
    Schedule(const PatchRules& rules, PatchSet& patches, bool reflex_too)
        : extent_of_(extents(patches, rules.mesh.triangles.size())) {
        const std::size_t triangles = rules.mesh.triangles.size();
        std::vector<std::vector<Placed>> steps(1);
        while ((triangles >> bits(steps.size() - 1)) > 0) steps.emplace_back();
        for (HalfEdge h = 0; h < 3 * triangles; ++h) {
            const HalfEdge twin = rules.edges.twin[h];
            if (twin == kNone || twin < h) continue;
            if (rules.edges.kind[h] == EdgeKind::reflex && !reflex_too) continue;
            const std::uint32_t a = patches.patch_of(h / 3), b = patches.patch_of(twin / 3);
            if (a == b) continue;
            const std::uint32_t first = std::min(extent_of_[a].first, extent_of_[b].first);
            const std::uint32_t last = std::max(extent_of_[a].last, extent_of_[b].last);
            std::size_t step = 0;
            while (first >> bits(step) != last >> bits(step)) ++step;
            steps[step].push_back({first >> bits(step), h});
        }
        for (std::size_t step = 0; step < steps.size(); ++step) {
            add_step(steps[step], (triangles >> bits(step)) + 1);
        }
    }

    static unsigned bits(std::size_t step) {
        return kFirstBits + kMoreBits * static_cast<unsigned>(step);
    }
    [[nodiscard]] std::size_t steps() const {
        return edges_.size();
    }
    [[nodiscard]] std::size_t parts(std::size_t step) const {
        return first_[step].size() - 1;
    }
    [[nodiscard]] std::span<const HalfEdge> edges(std::size_t step, std::size_t part) const {
        return std::span(edges_[step])
            .subspan(first_[step][part], first_[step][part + 1] - first_[step][part]);
    }
    [[nodiscard]] const std::vector<std::vector<HalfEdge>>& all() const {
        return edges_;
    }

private:
    struct Placed {
        std::uint32_t part;
        HalfEdge edge;
    };
    /// The lowest and highest triangle of a patch. A patch of several triangles may span parts.
    struct Extent {
        std::uint32_t first = kNone;
        std::uint32_t last = 0;
    };
    static std::vector<Extent> extents(PatchSet& patches, std::size_t triangles) {
        std::vector<Extent> extents(triangles);
        for (std::uint32_t t = 0; t < triangles; ++t) {
            Extent& extent = extents[patches.patch_of(t)];
            extent = {std::min(extent.first, t), std::max(extent.last, t)};
        }
        return extents;
    }
    void add_step(std::vector<Placed>& placed, std::size_t parts) {
        std::stable_sort(placed.begin(), placed.end(),
                         [](const Placed& a, const Placed& b) { return a.part < b.part; });
        std::vector<std::size_t> first(parts + 1, 0);
        for (const Placed& edge : placed) ++first[edge.part + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<HalfEdge>& edges = edges_.emplace_back();
        edges.reserve(placed.size());
        for (const Placed& edge : placed) edges.push_back(edge.edge);
        first_.push_back(std::move(first));
    }

    std::vector<Extent> extent_of_;
    std::vector<std::vector<HalfEdge>> edges_;
    std::vector<std::vector<std::size_t>> first_;
};

struct Turn {
    double rank;
    HalfEdge edge;
    float flatness;
    bool operator<(const Turn& other) const {  // the least rank first
        return rank != other.rank ? rank > other.rank : edge > other.edge;
    }
};

/// Joins patches over the edges of one part.
class Merger {
public:
    Merger(const PatchRules& rules, PatchSet& patches, std::vector<std::uint32_t>& live,
           PatchScope scope)
        : rules_(rules), patches_(patches), live_(live), scope_(std::move(scope)) {}

    void run(std::span<const HalfEdge> edges) {
        std::vector<Turn> turns;
        turns.reserve(edges.size());
        for (const HalfEdge h : edges) {
            const auto flat = static_cast<float>(flatness(rules_, h));
            turns.push_back({rank(h, flat), h, flat});
        }
        std::priority_queue<Turn> queue(std::less<Turn>{}, std::move(turns));
        while (!queue.empty()) {
            const Turn turn = queue.top();
            queue.pop();
            const double now = rank(turn.edge, turn.flatness);
            if (now > turn.rank) {
                queue.push({now, turn.edge, turn.flatness});
            } else {
                try_edge(turn.edge);
            }
        }
    }

private:
    /// Returns the rank of an edge; the least is tried first. Without a tolerance, few patches fit.
    /// Edges that leave the fewest others come first, and sharp ones before flat ones. With a
    /// tolerance, most patches fit at first. Then patches should grow evenly and round, flat parts
    /// first.
    [[nodiscard]] double rank(HalfEdge h, double flat) {
        const std::uint32_t a = patches_.patch_of(h / 3);
        const std::uint32_t b = patches_.patch_of(rules_.edges.twin[h] / 3);
        const auto live = static_cast<double>(live_[a] + live_[b]);
        if (rules_.keeps_inside) return live + kFlatWeight * flat;
        const auto faces = static_cast<double>(patches_.faces(a).size() + patches_.faces(b).size());
        return faces + kSideWeight * live - kFlatWeight * flat;
    }
    void try_edge(HalfEdge h) {
        const std::uint32_t a = patches_.patch_of(h / 3);
        const std::uint32_t b = patches_.patch_of(rules_.edges.twin[h] / 3);
        if (a == b) {
            live_[a] -= 2;
            return;
        }
        --live_[a];
        --live_[b];
        if (!patches_.can_join(a, b, scope_)) return;
        const std::uint32_t both = live_[a] + live_[b];
        live_[patches_.join(a, b, scope_)] = both;
    }

    const PatchRules& rules_;
    PatchSet& patches_;
    std::vector<std::uint32_t>& live_;  ///< by patch: its sides at edges not yet tried
    PatchScope scope_;
};

}  // namespace

void merge_patches(const PatchRules& rules, PatchSet& patches, std::uint64_t work,
                   const mesh::StopCheck& stop, ParallelFor parallel_for) {
    const Schedule schedule(rules, patches, !rules.keeps_inside);
    const std::size_t triangles = rules.mesh.triangles.size();
    std::vector<std::uint32_t> live(triangles, 0);
    for (const auto& edges : schedule.all()) {
        for (const HalfEdge h : edges) {
            ++live[patches.patch_of(h / 3)];
            ++live[patches.patch_of(rules.edges.twin[h] / 3)];
        }
    }
    for (std::size_t step = 0; step < schedule.steps() && !mesh::is_stopped(stop); ++step) {
        const auto run = [&](std::size_t part) {
            const std::size_t size = std::size_t{1} << Schedule::bits(step);
            const std::size_t first = part * size, last = std::min(first + size, triangles);
            if (first >= last) return;
            PatchScope scope{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last),
                             work * (last - first)};
            Merger(rules, patches, live, std::move(scope)).run(schedule.edges(step, part));
        };
        parallel_for(schedule.parts(step), run);
    }
}

}  // namespace cdprep::convex
