// SPDX-License-Identifier: MIT
#include "cdprep/hulls.h"

#include <algorithm>
#include <cmath>

#include "cdprep/format/float_environment.h"
#include "core/require.h"

namespace cdprep {

using format::Hull;
using format::HullScope;

static_assert(kDirectionStarts == format::kHullStarts);

std::optional<std::uint32_t> find_hull(const Model& model, HullScope scope,
                                       std::uint32_t number) noexcept {
    require(model, Ask::hulls);
    const auto place = [](const Hull& hull) {
        return std::uint64_t{static_cast<std::uint32_t>(hull.scope)} << 32 | hull.number;
    };
    const std::uint64_t sought = std::uint64_t{static_cast<std::uint32_t>(scope)} << 32 | number;
    const std::span<const Hull> hulls = model.hulls().hulls;
    const auto found =
        std::lower_bound(hulls.begin(), hulls.end(), sought,
                         [&](const Hull& hull, std::uint64_t key) { return place(hull) < key; });
    if (found == hulls.end() || place(*found) != sought) return std::nullopt;
    return static_cast<std::uint32_t>(found - hulls.begin());
}

EnclosingParts enclosing_parts(const Model& model) noexcept {
    const format::FloatEnvironment environment;
    if (!model.serves(Ask::hulls) || !model.is_balanced()) return {};
    if (model.record().components.size() != 1) return {};
    const std::optional<std::uint32_t> first = find_hull(model, HullScope::part);
    if (!first) return {};
    EnclosingParts parts{.first = *first};
    for (const Hull& hull : model.hulls().hulls.subspan(*first)) {
        const double size = hull.reach.x + hull.reach.y + hull.reach.z;
        // Only a damaged file holds other numbers.
        if (!(hull.distance >= 0 && std::isfinite(hull.distance + size))) return {};
        ++parts.count;
        parts.error = std::max(parts.error, hull.distance);
        parts.size = std::max(parts.size, size);
    }
    return parts;
}

ConvexPoints convex_points(const Model& model, std::uint32_t hull) noexcept {
    require(model, Ask::hulls);
    if (hull >= model.hulls().hulls.size()) stop_with("The model has no hull with this number.");
    const Hull& found = model.hulls().hulls[hull];
    ConvexPoints points;
    points.count = found.point_count;
    points.blocks = model.hulls().blocks.subspan(
        found.first_block, (found.point_count + format::kHullLanes - 1) / format::kHullLanes);
    points.reach = found.reach;
    if (found.neighbour_count == 0) return points;
    const auto words = model.hulls().neighbours.subspan(found.first_neighbour);
    points.neighbour_begins = words.first(std::size_t{found.point_count} + 1);
    points.neighbours = words.subspan(std::size_t{found.point_count} + 1, found.neighbour_count);
    points.starts = model.hulls().starts.subspan(found.first_start, found.start_count);
    return points;
}

}  // namespace cdprep
