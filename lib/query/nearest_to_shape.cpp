// SPDX-License-Identifier: MIT
#include "query/nearest_to_shape.h"

#include <algorithm>

#include "core/triangle_facts.h"
#include "exact/triangle_distance.h"
#include "walk/shape_gap.h"
#include "walk/walk_ordered.h"

namespace cdprep {
namespace {

/// Calls near(triangle, corners, distance) for the triangles that may be at most the limit away.
/// `near` returns the new limit.
template <class Near>
void for_each_near(const MovedModel& model, const Corners& shape, ShapeGap& gap, double limit,
                   Workspace::Storage& scratch, Near&& near) noexcept {
    const auto leaf = [&](std::uint32_t index) {
        each_in_leaf(*model.model, index, [&](std::uint32_t i) {
            const Corners corners = model.corners(i);
            if (gap(corners) > limit) return true;
            const TriangleDistance d = triangle_distance(shape, corners, false);
            if (d.lower <= limit) limit = std::min(limit, near(i, corners, d));
            return true;
        });
        return gap.in_frame(limit);
    };
    walk_ordered(*model.model, scratch, gap.in_frame(limit), gap, leaf);
}

}  // namespace

std::optional<ShapeDistance> nearest_to_shape(const MovedModel& model, const Corners& shape,
                                              double limit, Workspace::Storage& scratch) noexcept {
    // First finds the distance in double. Then measures all triangles within it as tightly as
    // possible.
    ShapeGap gap(model, shape);
    double upper = std::numeric_limits<double>::infinity();
    for_each_near(model, shape, gap, limit, scratch,
                  [&](std::uint32_t, const Corners&, const TriangleDistance& d) {
                      if (d.upper < upper) {
                          upper = d.upper;
                          gap.point(d.on_a, d.on_b);
                      }
                      return upper;
                  });
    std::optional<ShapeDistance> best;
    double lower = upper;
    for_each_near(model, shape, gap, std::min(limit, upper), scratch,
                  [&](std::uint32_t i, const Corners& corners, const TriangleDistance&) {
                      const TriangleDistance d = triangle_distance(shape, corners, true);
                      lower = std::min(lower, d.lower);
                      const std::uint32_t source = source_number(*model.model, i);
                      const bool precedes = !best || d.upper < best->upper ||
                                            (d.upper == best->upper && source < best->triangle);
                      if (precedes) best = {0, d.upper, d.on_b, d.on_a, source};
                      return upper;
                  });
    if (!best) return std::nullopt;
    best->lower = std::min(lower, best->upper);
    if (best->lower > limit) return std::nullopt;
    return best;
}

ShapeDistance touching_at(const MovedModel& model, const Corners& shape,
                          std::uint32_t triangle) noexcept {
    const Corners corners = model.corners(triangle);
    const std::uint32_t source = source_number(*model.model, triangle);
    if (triangles_touch(shape, corners)) {
        const Double3 point = common_point(shape, corners);
        return {0, 0, point, point, source};
    }
    const TriangleDistance d = triangle_distance(shape, corners, false);
    return {0, 0, d.on_b, d.on_a, source};
}

}  // namespace cdprep
