// SPDX-License-Identifier: MIT
#include "nearest_to_shape.h"

#include <algorithm>
#include <cmath>

#include "contact_pairs.h"
#include "shape_frame.h"
#include "triangle_distance.h"
#include "walk_ordered.h"

namespace cdprep {
namespace {

double reach_of(const Corners& shape) noexcept {
    return std::max({ShapeFrame::largest(shape[0]), ShapeFrame::largest(shape[1]),
                     ShapeFrame::largest(shape[2])});
}

/// Lower bounds of the distance from a shape's box to boxes of a model, model units.
class ShapeGap {
public:
    ShapeGap(const MovedModel& model, const Corners& shape) noexcept
        : exponent_(model.model->header().frame_exponent) {
        const ShapeFrame frame(model, reach_of(shape));
        const FrameVector a = frame.at(shape[0]), b = frame.at(shape[1]), c = frame.at(shape[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            lower_[i] = std::min({a[i], b[i], c[i]});
            upper_[i] = std::max({a[i], b[i], c[i]});
        }
        slack_ = frame.slack();
    }

    double operator()(const format::BvhNode& node, std::uint32_t box) const noexcept {
        double squared = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double gap =
                std::max({0.0, node.lower[i][box] - upper_[i], lower_[i] - node.upper[i][box]});
            squared += gap * gap;
        }
        // Too far away for squares, or for the frame: prunes nothing.
        if (!(squared < kLargestSquare)) return 0;
        const double gap = std::sqrt(squared) * (1 - 0x1p-45) - 2 * slack_;
        return std::max(0.0, std::nextafter(std::ldexp(gap, -exponent_), 0.0));
    }

private:
    static constexpr double kLargestSquare = 0x1p1000;

    FrameVector lower_{}, upper_{};
    double slack_ = 0;
    int exponent_;
};

/// Calls near(triangle, distance) for the triangles that may be at most the limit away;
/// it returns the new limit.
template <class Near>
void for_each_near(const MovedModel& model, const Corners& shape, double limit,
                   Workspace::Storage& scratch, Near&& near) noexcept {
    const std::uint32_t count = model.model->triangle_count();
    const auto leaf = [&](std::uint32_t index) {
        const std::uint32_t first = index * format::kBvhWidth;
        for (std::uint32_t i = first; i < std::min(first + format::kBvhWidth, count); ++i) {
            const TriangleDistance d = triangle_distance(shape, model.corners(i), false);
            if (d.lower <= limit) limit = std::min(limit, near(i, d));
        }
        return limit;
    };
    walk_ordered(*model.model, scratch, limit, ShapeGap(model, shape), leaf);
}

}  // namespace

std::optional<ShapeDistance> nearest_to_shape(const MovedModel& model, const Corners& shape,
                                              double limit, Workspace::Storage& scratch) noexcept {
    // How near it is, as far as double can tell; then what is as near, as well as can be.
    double upper = std::numeric_limits<double>::infinity();
    for_each_near(model, shape, limit, scratch, [&](std::uint32_t, const TriangleDistance& d) {
        upper = std::min(upper, d.upper);
        return upper;
    });
    std::optional<ShapeDistance> best;
    double lower = upper;
    for_each_near(model, shape, std::min(limit, upper), scratch,
                  [&](std::uint32_t i, const TriangleDistance&) {
                      const TriangleDistance tight =
                          triangle_distance(shape, model.corners(i), true);
                      lower = std::min(lower, tight.lower);
                      const std::uint32_t source = source_number(*model.model, i);
                      const bool precedes = !best || tight.upper < best->upper ||
                                            (tight.upper == best->upper && source < best->triangle);
                      if (precedes) best = {0, tight.upper, tight.on_b, tight.on_a, source};
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
