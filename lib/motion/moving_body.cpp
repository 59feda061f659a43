// SPDX-License-Identifier: MIT
#include "motion/moving_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cdprep/advanced/model_views.h"
#include "core/numbers.h"
#include "exact/length_of.h"
#include "exact/powers_of_two.h"
#include "exact/vectors.h"

namespace cdprep {
namespace {

/// Bounds are computed with a few roundings.
constexpr double kRaised = 1 + 0x1p-40;

/// A box of the root, in the model's coordinates.
struct RootBox {
    Double3 middle;
    Double3 half;
};

/// Calls use(box) for each box of the root.
template <class Use>
void for_root_boxes(const Model& model, Use&& use) noexcept {
    const format::FileHeader& header = model.header();
    const format::BvhNode& root = model.bvh().nodes[0];
    const std::array<double, 3> origin = {header.frame_origin.x, header.frame_origin.y,
                                          header.frame_origin.z};
    const auto in_model = [&](double x) { return scaled(x, -header.frame_exponent); };
    for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
        if (root.lower[0][box] > root.upper[0][box]) continue;
        std::array<double, 3> middle{};
        std::array<double, 3> half{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lower = root.lower[axis][box], upper = root.upper[axis][box];
            middle[axis] = origin[axis] + in_model((lower + upper) / 2);
            half[axis] = in_model((upper - lower) / 2);
        }
        use(RootBox{{middle[0], middle[1], middle[2]}, {half[0], half[1], half[2]}});
    }
}

/// Returns the axis of the turn in the model's coordinates, where it does not move.
Double3 own_axis(const Motion::Parts& parts) noexcept {
    const std::array<double, 9>& r = parts.start_rotation;
    const Double3& k = parts.axis;
    return {r[0] * k.x + r[3] * k.y + r[6] * k.z, r[1] * k.x + r[4] * k.y + r[7] * k.z,
            r[2] * k.x + r[5] * k.y + r[8] * k.z};
}

/// Returns a bound of the distance of the box's points from an axis through `centre`. The distance
/// is the length of a cross product. Each of its components is bounded.
double reach_from_axis(const RootBox& box, const Double3& centre, const Double3& axis) noexcept {
    const Double3 arm = cross(axis, box.middle - centre);
    const Double3 k = {std::fabs(axis.x), std::fabs(axis.y), std::fabs(axis.z)};
    const Double3& h = box.half;
    return length_of(std::fabs(arm.x) + k.y * h.z + k.z * h.y,
                     std::fabs(arm.y) + k.z * h.x + k.x * h.z,
                     std::fabs(arm.z) + k.x * h.y + k.y * h.x);
}

/// Returns the largest |coordinate| that a vertex of the model can have.
double largest_coordinate(const Model& model) noexcept {
    return largest_of(model.header().frame_origin) + two_to(-model.header().frame_exponent);
}

// The path is x(t) = R(t) (p - c) + c(t), with exact sums and an exact turn of the stored rotation.
// A pose that at() computes, and the vertices that a query moves by it, are off by roundings. The
// turn is off by those of its angle, too. The poses at 0 and 1 are given. So their entries may
// differ from the path's by end_error, and each coordinate by three times this.
double deviation_of(const Model& model, const Motion::Parts& parts) noexcept {
    constexpr double kRounding = 0x1p-44;
    const double arm = largest_coordinate(model) + largest_of(parts.centre);
    const double places =
        largest_of(parts.start_of_centre) + largest_of(parts.start_of_centre + parts.shift) +
        largest_of(parts.start.translation()) + largest_of(parts.end.translation());
    return 6 * parts.end_error * arm + kRounding * (1 + parts.angle) * (arm + places);
}

}  // namespace

MovingBody::MovingBody(const Model& model, const Motion& motion) noexcept
    : motion_(&motion), radius_(0), deviation_(deviation_of(model, motion.parts())) {
    const Motion::Parts& parts = motion.parts();
    const Double3 axis = own_axis(parts);
    double size = 0;
    for_root_boxes(model, [&](const RootBox& box) {
        radius_ = std::max(radius_, reach_from_axis(box, parts.centre, axis));
        size = std::max(size, length_of(box.half));
    });
    // The vertices lie in these boxes up to the roundings of their middles.
    radius_ = radius_ * kRaised + 8 * kUnit * largest_coordinate(model);
    triangle_size_ = 4 * size / std::sqrt(static_cast<double>(model.triangle_count()));
}

Extent MovingBody::extent(const Corners& corners, const Double3& direction,
                          double time) const noexcept {
    const Motion::Parts& parts = motion_->parts();
    const Double3 centre = parts.start_of_centre + time * parts.shift;
    const double straight = dot(direction, parts.shift);
    // n . (w x y) = (n x w) . y
    const Double3 across = parts.angle * cross(direction, parts.axis);
    Extent extent = {kInfinity, -kInfinity, kInfinity, -kInfinity, 0};
    for (const Double3& corner : corners) {
        const Double3 arm = corner - centre;
        const double place = dot(direction, corner);
        const double velocity = straight + dot(across, arm);
        extent.lowest = std::min(extent.lowest, place);
        extent.highest = std::max(extent.highest, place);
        extent.slowest = std::min(extent.slowest, velocity);
        extent.fastest = std::max(extent.fastest, velocity);
        extent.bend = std::max(extent.bend, length_of(arm));
    }
    extent.bend *= parts.angle * parts.angle * kRaised;
    return extent;
}

double greatest_speed(const MovingBody& a, const MovingBody& b) noexcept {
    return (length_of(b.shift() - a.shift()) + a.turning_speed() + b.turning_speed()) * kRaised;
}

double time_apart(double gap, double closing, double bend) noexcept {
    if (!(gap > 0)) return 0;
    // No square under- or overflows, and no difference cancels.
    const double root = length_of(closing, std::sqrt(2 * bend) * std::sqrt(gap), 0);
    if (closing > 0) return 2 * (gap / (closing + root));
    return bend > 0 ? (root - closing) / bend : kInfinity;
}

}  // namespace cdprep
