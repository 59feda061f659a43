// SPDX-License-Identifier: MIT
#include "cdprep/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact_pairs.h"
#include "point_triangle_distance.h"
#include "walk_ordered.h"

namespace cdprep {
namespace {

/// Lower bounds of the distance from a point to boxes, in model units. The point
/// is taken into the frame in double; that and the sum of squares are off by less
/// than 16 u (|q| + |origin| + size), which is taken off.
class BoxDistance {
public:
    BoxDistance(const format::FileHeader& header, const Double3& q) noexcept
        : exponent_(header.frame_exponent) {
        const Double3& o = header.frame_origin;
        const std::array<double, 3> at = {q.x - o.x, q.y - o.y, q.z - o.z};
        for (std::size_t i = 0; i < 3; ++i) point_[i] = std::ldexp(at[i], exponent_);
        slack_ = 0x1p-49 * (std::fabs(q.x) + std::fabs(q.y) + std::fabs(q.z) + std::fabs(o.x) +
                            std::fabs(o.y) + std::fabs(o.z) + std::ldexp(1.0, -exponent_)) +
                 kSubnormal;
    }

    double operator()(const format::BvhNode& node, std::uint32_t box) const noexcept {
        std::array<double, 3> gap{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            gap[axis] = std::max(
                {0.0, node.lower[axis][box] - point_[axis], point_[axis] - node.upper[axis][box]});
        }
        const double distance = std::ldexp(std::hypot(gap[0], gap[1], gap[2]), -exponent_);
        // A point so far away that it leaves the frame's range prunes nothing.
        return std::isfinite(distance) ? distance - slack_ : 0;
    }

private:
    static constexpr double kSubnormal = 0x1p-1070;  ///< scaling back may round

    std::array<double, 3> point_{};
    int exponent_;
    double slack_;
};

}  // namespace

std::optional<ClosestPoint> closest_point(const Model& model, const Double3& query,
                                          Workspace& workspace, double max_distance) noexcept {
    const MovedModel still(model, nullptr);
    std::optional<ClosestPoint> best;
    double best_computed = std::numeric_limits<double>::infinity();
    double lower = best_computed;
    const auto look_at_leaf = [&](std::uint32_t leaf) {
        const std::uint32_t first = leaf * format::kBvhWidth;
        const std::uint32_t last = std::min(first + format::kBvhWidth, model.triangle_count());
        for (std::uint32_t i = first; i < last; ++i) {
            const PointTriangleDistance d = point_triangle_distance(query, still.corners(i));
            if (d.lower > max_distance) continue;
            lower = std::min(lower, d.lower);
            const std::uint32_t source = source_number(model, i);
            const double upper = best ? std::min(best->upper, d.upper) : d.upper;
            const bool nearer = !best || d.computed < best_computed ||
                                (d.computed == best_computed && source < best->triangle);
            if (nearer) {
                best = ClosestPoint{d.nearest, 0, upper, source};
                best_computed = d.computed;
            } else {
                best->upper = upper;
            }
        }
        return best ? best->upper : max_distance;
    };
    walk_ordered(model, workspace.storage(), max_distance, BoxDistance(model.header(), query),
                 look_at_leaf);
    if (best) best->lower = std::min(lower, best->upper);
    return best;
}

}  // namespace cdprep
