// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/join_cells.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

#include "decompose/enclose/flush_bound.h"
#include "decompose/enclose/hull_error.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::middle_of;

using Cells = std::vector<std::uint32_t>;

constexpr double kNearlyExact = 1e-5;      ///< of the diagonal: counts as exact
constexpr std::size_t kMostLooks = 2'000;  ///< cells of one trial; beyond that, the trial fails

class Joiner {
public:
    Joiner(const SolidCells& cells, std::span<const std::uint32_t> wanted, const Solid& solid,
           double error)
        : cells_(cells), wanted_(wanted), solid_(solid), error_(error) {
        for (const std::uint32_t number : wanted) {
            const SolidCell& cell = cells.cells[number];
            std::vector<Double3> points = cell.corners;
            for (const std::uint32_t fragment : cell.fragments) {
                for (const std::uint32_t place : cells.fragments[fragment].place) {
                    points.push_back(cells.places[place].lower);
                    points.push_back(cells.places[place].upper);
                }
            }
            points_.push_back(convex_hull(points).points);
            mesh::Box box = cell.box;
            const double near = kNearlyExact * solid.diagonal();
            box.lower = {box.lower.x - near, box.lower.y - near, box.lower.z - near};
            box.upper = {box.upper.x + near, box.upper.y + near, box.upper.z + near};
            box_.push_back(box);
            centre_.push_back(middle_of(box.lower, box.upper));
        }
    }

    std::vector<Cells> run(ParallelFor parallel_for) {
        std::vector<Cells> grown(wanted_.size());
        const auto grow_one = [&](std::size_t i) { grown[i] = grow(i); };
        parallel_for(grown.size(), grow_one);
        std::vector<Cells> chosen = choose(grown);
        for (Cells& part : chosen) {
            for (std::uint32_t& cell : part) cell = wanted_[cell];
        }
        return chosen;
    }

private:
    // A cell that does not fit will not fit later: hulls only grow.
    [[nodiscard]] Cells grow(std::size_t seed) const {
        Cells part = {static_cast<std::uint32_t>(seed)};
        std::vector<Double3> hull = points_[seed];
        std::vector<bool> seen(wanted_.size(), false);
        seen[seed] = true;
        using Next = std::pair<double, std::uint32_t>;
        std::priority_queue<Next, std::vector<Next>, std::greater<>> near;
        const auto see_around = [&](std::uint32_t cell) {
            for (std::uint32_t other = 0; other < wanted_.size(); ++other) {
                if (seen[other] || !are_neighbours(cell, other)) continue;
                seen[other] = true;
                near.push({mesh::squared_distance(centre_[other], centre_[seed]), other});
            }
        };
        see_around(part[0]);
        while (!near.empty()) {
            const std::uint32_t cell = near.top().second;
            near.pop();
            std::vector<Double3> points = hull;
            points.insert(points.end(), points_[cell].begin(), points_[cell].end());
            ConvexHull both = convex_hull(points);
            if (!is_within_error(both)) continue;
            hull = std::move(both.points);
            part.push_back(cell);
            see_around(cell);
        }
        std::sort(part.begin(), part.end());
        return part;
    }

    [[nodiscard]] bool are_neighbours(std::uint32_t a, std::uint32_t b) const {
        return cells_.cells[wanted_[a]].body == cells_.cells[wanted_[b]].body &&
               box_[a].meets(box_[b]);
    }

    [[nodiscard]] bool is_within_error(const ConvexHull& hull) const {
        const double exact = kNearlyExact * solid_.diagonal();
        const auto flush = bound_flush(hull, solid_, exact);
        if (flush && *flush <= std::max(error_, exact)) return true;
        if (error_ <= exact || bridges_gap(hull)) return false;
        HullErrorOptions how;
        how.enough = how.too_much = error_;
        how.most_cells = kMostLooks;
        return find_hull_error(hull, solid_, how).upper <= error_;
    }

    /// Returns true if the middle of two corners is too far out. A quick test.
    [[nodiscard]] bool bridges_gap(const ConvexHull& hull) const {
        for (std::size_t i = 0; i < hull.points.size(); ++i) {
            for (std::size_t k = i + 1; k < hull.points.size(); ++k) {
                const Double3 p = middle_of(hull.points[i], hull.points[k]);
                if (solid_.tree().nearest(p).distance > error_ && !solid_.includes(p)) return true;
            }
        }
        return false;
    }

    /// Chooses, again and again, the part that takes in most of the cells left.
    [[nodiscard]] std::vector<Cells> choose(const std::vector<Cells>& grown) const {
        std::vector<Cells> chosen;
        std::vector<bool> is_left(wanted_.size(), true);
        const auto gain = [&](const Cells& part) {
            return std::count_if(part.begin(), part.end(),
                                 [&](std::uint32_t cell) { return is_left[cell]; });
        };
        for (std::size_t left = wanted_.size(); left > 0;) {
            const auto best =
                std::max_element(grown.begin(), grown.end(),
                                 [&](const Cells& a, const Cells& b) { return gain(a) < gain(b); });
            left -= static_cast<std::size_t>(gain(*best));
            for (const std::uint32_t cell : *best) is_left[cell] = false;
            chosen.push_back(*best);
        }
        drop_needless(chosen);
        return chosen;
    }

    /// Removes parts whose cells are all in others, the smallest first. A cell belongs to the
    /// largest part that contains it, so such a part could be left without one.
    void drop_needless(std::vector<Cells>& parts) const {
        std::vector<std::uint32_t> uses(wanted_.size(), 0);
        for (const Cells& part : parts) {
            for (const std::uint32_t cell : part) ++uses[cell];
        }
        std::vector<std::size_t> order(parts.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return parts[a].size() < parts[b].size();
        });
        for (const std::size_t i : order) {
            Cells& part = parts[i];
            const bool needless = std::all_of(part.begin(), part.end(),
                                              [&](std::uint32_t cell) { return uses[cell] > 1; });
            if (!needless) continue;
            for (const std::uint32_t cell : part) --uses[cell];
            part.clear();
        }
        std::erase_if(parts, [](const Cells& part) { return part.empty(); });
    }

    const SolidCells& cells_;
    std::span<const std::uint32_t> wanted_;
    const Solid& solid_;
    double error_;
    std::vector<std::vector<Double3>> points_;  ///< of each wanted cell's hull
    std::vector<mesh::Box> box_;                ///< a little enlarged
    std::vector<Double3> centre_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> join_cells(const SolidCells& cells,
                                                   std::span<const std::uint32_t> wanted,
                                                   const Solid& solid, double error,
                                                   ParallelFor parallel_for) {
    if (wanted.empty()) return {};
    return Joiner(cells, wanted, solid, error).run(parallel_for);
}

}  // namespace cdprep::convex
