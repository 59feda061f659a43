// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/stars.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace cdprep::mesh {

Stars collect_stars(const Mesh& mesh) {
    Stars stars;
    stars.first.assign(mesh.positions.size() + 2, 0);
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) ++stars.first[vertex + 2];
    }
    std::partial_sum(stars.first.begin(), stars.first.end(), stars.first.begin());
    stars.corner.resize(3 * mesh.triangles.size());
    // first[v + 1] is the position of the next corner of v; finally it is the end of v's
    // corners.
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.triangles[i].vertex;
        stars.corner[stars.first[a + 1]++] = {i, c, b};
        stars.corner[stars.first[b + 1]++] = {i, a, c};
        stars.corner[stars.first[c + 1]++] = {i, b, a};
    }
    stars.first.pop_back();
    return stars;
}

bool is_one_closed_fan(std::span<const StarCorner> star) {
    constexpr std::size_t kMost = 24;  // for more, sorting is faster than testing all pairs
    if (star.size() > kMost) return false;
    // Walks from corner to corner across each corner's `after` edge. A walk that visits every
    // corner once is one cycle. So each edge is the `before` of exactly one corner and the
    // `after` of exactly one.
    std::size_t at = 0;
    for (std::size_t step = 1; step <= star.size(); ++step) {
        const std::uint32_t wanted = star[at].after;
        std::size_t next = 0;
        while (next < star.size() && star[next].before != wanted) ++next;
        if (next == star.size()) return false;
        if (next == 0) return step == star.size();
        at = next;
    }
    return false;
}

void sort_edge_uses(std::span<const StarCorner> star, std::vector<EdgeUse>& uses) {
    uses.clear();
    for (std::uint32_t i = 0; i < star.size(); ++i) {
        uses.push_back({star[i].before, i, false});
        uses.push_back({star[i].after, i, true});
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.other, a.corner) < std::tie(b.other, b.corner);
    });
}

}  // namespace cdprep::mesh
