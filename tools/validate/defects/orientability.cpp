// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/orientability.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace cdprep::mesh {
namespace {

/// Disjoint sets of triangles; each triangle is marked if its winding is opposite to its root's.
class TurnedSets {
public:
    explicit TurnedSets(std::size_t count) : parent_(count), turned_(count, 0) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    /// Joins two triangles with opposite windings, or with equal ones. Returns false if they are
    /// already joined the other way.
    bool join(std::uint32_t a, std::uint32_t b, bool against) {
        const Root root_a = root_of(a);
        const Root root_b = root_of(b);
        const bool turn = (root_a.turned != root_b.turned) != against;
        if (root_a.number == root_b.number) return !turn;
        const std::uint32_t upper = std::max(root_a.number, root_b.number);
        parent_[upper] = std::min(root_a.number, root_b.number);
        turned_[upper] = turn ? 1 : 0;
        return true;
    }

private:
    struct Root {
        std::uint32_t number;
        bool turned;
    };

    Root root_of(std::uint32_t number) {
        bool turned = false;
        while (parent_[number] != number) {
            const std::uint32_t up = parent_[number];
            turned_[number] ^= turned_[up];  // the root's value is 0
            parent_[number] = parent_[up];
            turned ^= turned_[number] != 0;
            number = parent_[number];
        }
        return {number, turned};
    }

    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> turned_;
};

/// Returns the first edge at the vertex whose condition cannot hold; joins the others.
std::optional<NonOrientable> join_at(std::uint32_t vertex, std::span<const StarCorner> star,
                                     std::vector<EdgeUse>& uses, TurnedSets& sets) {
    sort_edge_uses(star, uses);
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i;
        while (end < uses.size() && uses[end].other == uses[i].other) ++end;
        if (end - i == 2 && uses[i].other > vertex) {
            const std::uint32_t a = star[uses[i].corner].triangle;
            const std::uint32_t b = star[uses[i + 1].corner].triangle;
            if (!sets.join(a, b, uses[i].outgoing == uses[i + 1].outgoing)) {
                return NonOrientable{0, a, b};
            }
        }
        i = end;
    }
    return std::nullopt;
}

}  // namespace

std::vector<NonOrientable> find_non_orientable(const Stars& stars,
                                               const ComponentNumbers& components,
                                               const EdgeFlaws& flaws) {
    std::vector<NonOrientable> found;
    if (flaws.inconsistent.empty()) return found;
    std::vector<bool> doubtful(components.count);
    for (const FlawedEdge& edge : flaws.inconsistent) {
        doubtful[components.of_vertex[edge.from]] = true;
    }
    TurnedSets sets(stars.corner.size() / 3);
    std::vector<EdgeUse> uses;
    for (std::uint32_t vertex = 0; vertex + 1 < stars.first.size(); ++vertex) {
        const std::uint32_t component = components.of_vertex[vertex];
        if (!doubtful[component]) continue;
        if (auto conflict = join_at(vertex, stars.at(vertex), uses, sets)) {
            conflict->component = component;
            found.push_back(*conflict);
            doubtful[component] = false;
        }
    }
    std::sort(found.begin(), found.end(), [](const NonOrientable& a, const NonOrientable& b) {
        return a.component < b.component;
    });
    return found;
}

}  // namespace cdprep::mesh
