// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/edge_flaws.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "cdprep/advanced/disjoint_sets.h"

namespace cdprep::mesh {
namespace {

/// Returns the lowest triangle of each fan. Corners with a common edge belong to one fan.
std::vector<std::uint32_t> fans_of(std::span<const StarCorner> star,
                                   const std::vector<EdgeUse>& uses) {
    build::DisjointSets fans(star.size());
    for (std::size_t i = 1; i < uses.size(); ++i) {
        if (uses[i].other == uses[i - 1].other) fans.unite(uses[i].corner, uses[i - 1].corner);
    }
    std::vector<std::uint32_t> lowest;
    for (std::uint32_t i = 0; i < star.size(); ++i) {
        if (fans.root_of(i) == i) lowest.push_back(star[i].triangle);
    }
    return lowest;
}

/// Examines one star after the other; reuses its scratch memory.
class StarReader {
public:
    explicit StarReader(EdgeFlaws& flaws) : flaws_(flaws) {}

    void read(std::uint32_t vertex, std::span<const StarCorner> star) {
        sort_edge_uses(star, uses_);
        for (std::size_t i = 0; i < uses_.size();) {
            std::size_t end = i;
            while (end < uses_.size() && uses_[end].other == uses_[i].other) ++end;
            // Each edge is read at its lower end.
            if (uses_[i].other > vertex) {
                read_edge(vertex, star, std::span(uses_).subspan(i, end - i));
            }
            i = end;
        }
        const std::size_t fans = fans_of(star, uses_).size();
        if (fans > 1) flaws_.pinched.push_back({vertex, static_cast<std::uint32_t>(fans)});
        find_repeated(vertex, star);
    }

private:
    void read_edge(std::uint32_t vertex, std::span<const StarCorner> star,
                   std::span<const EdgeUse> uses) {
        std::int64_t balance = 0;
        for (const EdgeUse& use : uses) balance += use.outgoing ? 1 : -1;
        if (balance != 0) flaws_.unbalanced.push_back(vertex);
        const EdgeUse& lowest = uses.front();
        FlawedEdge edge{star[lowest.corner].triangle, vertex, lowest.other,
                        static_cast<std::uint32_t>(uses.size())};
        if (!lowest.outgoing) std::swap(edge.from, edge.to);
        if (uses.size() == 1) flaws_.boundary.push_back(edge);
        if (uses.size() > 2) flaws_.non_manifold.push_back(edge);
        if (uses.size() == 2 && balance != 0) flaws_.inconsistent.push_back(edge);
    }

    /// Finds repeated triangles; examines each triangle at its lowest corner.
    void find_repeated(std::uint32_t vertex, std::span<const StarCorner> star) {
        const auto key = [](const StarCorner& c) {
            return std::make_tuple(std::min(c.before, c.after), std::max(c.before, c.after),
                                   c.triangle);
        };
        lowest_here_.clear();
        for (const StarCorner& corner : star) {
            if (std::min(corner.before, corner.after) > vertex) lowest_here_.push_back(corner);
        }
        std::sort(lowest_here_.begin(), lowest_here_.end(),
                  [&](const StarCorner& a, const StarCorner& b) { return key(a) < key(b); });
        std::size_t first = 0;
        for (std::size_t i = 1; i < lowest_here_.size(); ++i) {
            const StarCorner& a = lowest_here_[first];
            const StarCorner& b = lowest_here_[i];
            const bool same = a.before == b.before && a.after == b.after;
            const bool opposite = a.before == b.after && a.after == b.before;
            if (same || opposite) {
                flaws_.repeated.push_back({b.triangle, a.triangle, opposite});
            } else {
                first = i;
            }
        }
    }

    EdgeFlaws& flaws_;
    std::vector<EdgeUse> uses_;
    std::vector<StarCorner> lowest_here_;
};

}  // namespace

EdgeFlaws find_edge_flaws(const Stars& stars) {
    EdgeFlaws flaws;
    StarReader reader(flaws);
    for (std::uint32_t vertex = 0; vertex + 1 < stars.first.size(); ++vertex) {
        const std::span<const StarCorner> star = stars.at(vertex);
        // Two triangles back to back form a closed fan too.
        if (star.size() > 2 && is_one_closed_fan(star)) continue;
        reader.read(vertex, star);
    }
    return flaws;
}

std::vector<std::uint32_t> lowest_of_fans(std::span<const StarCorner> star) {
    std::vector<EdgeUse> uses;
    sort_edge_uses(star, uses);
    return fans_of(star, uses);
}

}  // namespace cdprep::mesh
