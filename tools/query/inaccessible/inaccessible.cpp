// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/inaccessible/inaccessible.h"

#include <algorithm>

#include "query/inaccessible/cap_tree.h"
#include "query/inaccessible/radial_cover.h"

namespace cdprep::mesh {
namespace {

constexpr std::size_t kViewedPerTask = 256;

}  // namespace

Inaccessible find_inaccessible(const Double3& centre, std::span<const Double3> positions,
                               std::span<const Triangle> triangles, ParallelFor parallel_for) {
    const RadialCover cover(centre, positions, triangles);
    const CapTree caps(centre, positions, triangles, parallel_for);
    std::vector<std::uint8_t> hidden(triangles.size());
    const auto task = [&](std::size_t number) {
        std::vector<std::uint32_t> others;
        const std::size_t first = number * kViewedPerTask;
        const std::size_t last = std::min(first + kViewedPerTask, triangles.size());
        for (std::size_t i = first; i < last; ++i) {
            const auto triangle = static_cast<std::uint32_t>(i);
            if (cover.is_edge_on(triangle)) continue;
            caps.find_others(triangle, others);
            hidden[i] = cover.is_hidden(triangle, others) ? 1 : 0;
        }
    };
    parallel_for((triangles.size() + kViewedPerTask - 1) / kViewedPerTask, task);
    Inaccessible result;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        if (hidden[i] != 0) result.triangles.push_back(i);
        if (cover.is_edge_on(i)) ++result.edge_on;
    }
    return result;
}

}  // namespace cdprep::mesh
