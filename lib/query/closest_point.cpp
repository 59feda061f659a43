// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "core/triangle_facts.h"
#include "exact/point_triangle_distance.h"
#include "query/shape_gap.h"
#include "walk/walk_ordered.h"

namespace cdprep {

std::optional<ClosestPoint> closest_point(const Model& model, const Double3& query,
                                          Workspace& workspace, double max_distance) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::closest);
    const MovedModel still(model, nullptr);
    ShapeGap gap(still, {query, query, query});
    std::optional<ClosestPoint> best;
    double best_computed = std::numeric_limits<double>::infinity();
    double lower = best_computed;
    const auto look_at_leaf = [&](std::uint32_t leaf) {
        const std::uint32_t first = leaf * format::kBvhWidth;
        const std::uint32_t last = std::min(first + format::kBvhWidth, model.triangle_count());
        for (std::uint32_t i = first; i < last; ++i) {
            const Corners corners = still.corners(i);
            if (gap(corners) > (best ? best->upper : max_distance)) continue;
            const PointTriangleDistance d = point_triangle_distance(query, corners);
            if (d.lower > max_distance) continue;
            lower = std::min(lower, d.lower);
            const std::uint32_t source = source_number(model, i);
            const double upper = best ? std::min(best->upper, d.upper) : d.upper;
            const bool nearer = !best || d.computed < best_computed ||
                                (d.computed == best_computed && source < best->triangle);
            if (nearer) {
                best = ClosestPoint{d.nearest, 0, upper, source};
                best_computed = d.computed;
                gap.point(query, d.nearest);
            } else {
                best->upper = upper;
            }
        }
        return gap.in_frame(best ? best->upper : max_distance);
    };
    walk_ordered(model, workspace.storage(), gap.in_frame(max_distance), gap, look_at_leaf);
    if (best) best->lower = std::min(lower, best->upper);
    return best;
}

}  // namespace cdprep
