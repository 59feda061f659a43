// SPDX-License-Identifier: MIT
#include "walk/nearest_triangle.h"

#include <algorithm>
#include <limits>

#include "core/triangle_facts.h"
#include "exact/point_triangle_distance.h"
#include "walk/shape_gap.h"
#include "walk/walk_ordered.h"

namespace cdprep {

std::optional<NearestTriangle> nearest_triangle(const MovedModel& model, const Double3& query,
                                                double max_distance,
                                                Workspace::Storage& scratch) noexcept {
    ShapeGap gap(model, {query, query, query});
    std::optional<NearestTriangle> best;
    double best_computed = std::numeric_limits<double>::infinity();
    double lower = best_computed;
    std::uint32_t best_source = 0;
    const auto look_at_leaf = [&](std::uint32_t leaf) {
        each_in_leaf(*model.model, leaf, [&](std::uint32_t i) {
            const Corners corners = model.corners(i);
            if (gap(corners) > (best ? best->upper : max_distance)) return true;
            const PointTriangleDistance d = point_triangle_distance(query, corners);
            if (d.lower > max_distance) return true;
            lower = std::min(lower, d.lower);
            const std::uint32_t source = source_number(*model.model, i);
            const double upper = best ? std::min(best->upper, d.upper) : d.upper;
            const bool nearer = !best || d.computed < best_computed ||
                                (d.computed == best_computed && source < best_source);
            if (nearer) {
                best = NearestTriangle{i, 0, upper, d.nearest};
                best_computed = d.computed;
                best_source = source;
                gap.point(query, d.nearest);
            } else {
                best->upper = upper;
            }
            return true;
        });
        return gap.in_frame(best ? best->upper : max_distance);
    };
    walk_ordered(*model.model, scratch, gap.in_frame(max_distance), gap, look_at_leaf);
    if (best) best->lower = std::min(lower, best->upper);
    return best;
}

}  // namespace cdprep
