// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/deform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

namespace cdprep::scenes {
namespace {

constexpr std::array<double Double3::*, 3> kAxes = {&Double3::x, &Double3::y, &Double3::z};

/// Returns the sine of a time in periods. The remainder keeps it exact after many of them.
double wave(double time_s, double period_s) {
    return std::sin(2 * std::numbers::pi * (std::fmod(time_s, period_s) / period_s));
}

}  // namespace

RestBox RestBox::of(std::span<const Double3> points) noexcept {
    if (points.empty()) return {};
    RestBox box = {points[0], points[0]};
    for (const Double3& point : points) {
        for (const auto axis : kAxes) {
            box.lower.*axis = std::min(box.lower.*axis, point.*axis);
            box.upper.*axis = std::max(box.upper.*axis, point.*axis);
        }
    }
    return box;
}

Double3 RestBox::middle() const noexcept {
    return {std::midpoint(lower.x, upper.x), std::midpoint(lower.y, upper.y),
            std::midpoint(lower.z, upper.z)};
}

double Shear::factor(double time_s) const noexcept {
    return period_s > 0 ? amplitude * wave(time_s, period_s) : rate_per_s * time_s;
}

double Twist::angle(double time_s) const noexcept {
    return angle_rad * wave(time_s, period_s);
}

void shear(const Shear& shear, double factor, const RestBox& box, std::span<const Double3> rest,
           std::span<Double3> moved) noexcept {
    const auto of = kAxes[shear.of], along = kAxes[shear.along];
    const double middle = box.middle().*along;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        moved[i] = rest[i];
        moved[i].*of += factor * (rest[i].*along - middle);
    }
}

void twist(const Twist& twist, double angle, const RestBox& box, std::span<const Double3> rest,
           std::span<Double3> moved) noexcept {
    const auto axis = kAxes[twist.axis];
    const auto u = kAxes[(twist.axis + 1) % 3], v = kAxes[(twist.axis + 2) % 3];
    const Double3 middle = box.middle();
    const double length = box.upper.*axis - box.lower.*axis;
    std::ranges::copy(rest, moved.begin());
    if (angle == 0 || length == 0) return;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const double turn = angle * ((rest[i].*axis - middle.*axis) / length);
        const double cosine = std::cos(turn), sine = std::sin(turn);
        const double du = rest[i].*u - middle.*u, dv = rest[i].*v - middle.*v;
        moved[i].*u = middle.*u + cosine * du - sine * dv;
        moved[i].*v = middle.*v + sine * du + cosine * dv;
    }
}

}  // namespace cdprep::scenes
