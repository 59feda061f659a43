// SPDX-License-Identifier: MIT
#include "cdprep/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "cdprep/format/float_environment.h"
#include "core/moved_point.h"
#include "core/number_text.h"
#include "exact/length_of.h"
#include "exact/vectors.h"

namespace cdprep {
namespace {

using Matrix = std::array<double, 9>;

Matrix product(const Matrix& a, const Matrix& b) noexcept {
    Matrix result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            result[3 * i + j] =
                (a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j]) + a[3 * i + 2] * b[6 + j];
        }
    }
    return result;
}

Matrix transposed(const Matrix& m) noexcept {
    return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

double largest_difference(const Matrix& a, const Matrix& b) noexcept {
    double most = 0;
    for (std::size_t i = 0; i < 9; ++i) most = std::max(most, std::fabs(a[i] - b[i]));
    return most;
}

Double3 turned(const Matrix& r, const Double3& p) noexcept {
    return {(r[0] * p.x + r[1] * p.y) + r[2] * p.z, (r[3] * p.x + r[4] * p.y) + r[5] * p.z,
            (r[6] * p.x + r[7] * p.y) + r[8] * p.z};
}

/// An axis and an angle of 0 or more, in radians.
struct Turn {
    Double3 axis;
    double angle;
};

Turn turn_of(const Double3& v) noexcept {
    const double most = largest_of(v);
    if (most == 0) return {{1, 0, 0}, 0};
    const Double3 scaled = {v.x / most, v.y / most, v.z / most};  // so that no square underflows
    const double length = std::sqrt(dot(scaled, scaled));
    return {(1 / length) * scaled, most * length};
}

/// Returns the turn of a rotation matrix, by pi at most. Its quaternion w + xi + yj + zk comes from
/// the row with the largest component. So none is the quotient of small numbers (Shepperd 1978).
Turn turn_of(const Matrix& r) noexcept {
    const std::array<double, 4> squares = {
        1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8],
        1 - r[0] - r[4] + r[8]};  // four times those of w, x, y and z
    const std::array<std::array<double, 4>, 4> rows = {{
        {squares[0], r[7] - r[5], r[2] - r[6], r[3] - r[1]},
        {r[7] - r[5], squares[1], r[1] + r[3], r[2] + r[6]},
        {r[2] - r[6], r[1] + r[3], squares[2], r[5] + r[7]},
        {r[3] - r[1], r[2] + r[6], r[5] + r[7], squares[3]},
    }};
    const auto largest = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) -
                                                  squares.begin());
    const std::array<double, 4>& q = rows[largest];
    const double sign = q[0] < 0 ? -1 : 1;
    const Turn half = turn_of(Double3{sign * q[1], sign * q[2], sign * q[3]});
    return {half.axis, 2 * std::atan2(half.angle, sign * q[0])};
}

/// Returns the rotation by an angle about a unit axis.
Matrix rotation_about(const Double3& axis, double angle) noexcept {
    const double w = std::cos(angle / 2), s = std::sin(angle / 2);
    const double x = s * axis.x, y = s * axis.y, z = s * axis.z;
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

Matrix rotation_at(const Motion::Parts& parts, double time) noexcept {
    return product(rotation_about(parts.axis, time * parts.angle), parts.start_rotation);
}

/// Requires parts without a fault.
Pose pose_at(const Motion::Parts& parts, double time) noexcept {
    const Matrix r = rotation_at(parts, time);
    const Double3 t = (parts.start_of_centre + time * parts.shift) - turned(r, parts.centre);
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x, t.y, t.z})
        .value();
}

std::optional<Error> too_large(const char* what, double value, double most) {
    if (value <= most) return std::nullopt;
    return Error{ErrorCode::bad_argument, std::string("The ") + what + " of the motion is " +
                                              number_text(value) + "; at most " +
                                              number_text(most) + " is allowed."};
}

/// Returns the largest coordinate, or NaN if one is that.
double worst_of(const Double3& p) noexcept {
    const double sum = p.x + p.y + p.z;
    return std::isnan(sum) && !std::isinf(largest_of(p)) ? sum : largest_of(p);
}

/// Returns why a pose of the motion might be beyond the largest coordinate.
std::optional<Error> find_fault(const Motion::Parts& parts) {
    constexpr double kMost = format::kMaxCoordinate;
    if (auto error = too_large("centre", worst_of(parts.centre), kMost)) return error;
    if (auto error = too_large("shift", worst_of(parts.shift), kMost)) return error;
    // A turned centre is at most sqrt 3 times its largest coordinate from the origin.
    const Double3& c = parts.start_of_centre;
    return too_large(
        "farthest point",
        std::max(largest_of(c), largest_of(c + parts.shift)) + 2 * largest_of(parts.centre), kMost);
}

}  // namespace

Motion::Motion(const Pose& world_from_model) noexcept
    : parts_{world_from_model,
             world_from_model,
             {},
             world_from_model.translation(),
             {},
             {1, 0, 0},
             0,
             world_from_model.rotation(),
             0} {}

Result<Motion> Motion::between(const Pose& start, const Pose& end, const Double3& centre) {
    const format::FloatEnvironment environment;
    const auto first = composed_pose(Pose(), start);  // its rotation is orthonormal
    const auto last = composed_pose(Pose(), end);
    if (!first) return first.error();
    if (!last) return last.error();
    const Matrix from = first.value().rotation();
    const Turn turn = turn_of(product(last.value().rotation(), transposed(from)));
    const Double3 begin = moved_point(start, centre);
    Parts parts = {start,     end,        centre, begin, moved_point(end, centre) - begin,
                   turn.axis, turn.angle, from,   0};
    if (auto fault = find_fault(parts)) return *std::move(fault);
    parts.end_error = std::max(largest_difference(start.rotation(), from),
                               largest_difference(end.rotation(), rotation_at(parts, 1)));
    return Motion(parts);
}

Result<Motion> Motion::by_velocity(const Pose& start, const Double3& shift, const Double3& turn,
                                   const Double3& centre) {
    const format::FloatEnvironment environment;
    if (auto error = too_large("turn", worst_of(turn), kMostTurn)) return *std::move(error);
    const Turn by = turn_of(turn);
    if (auto error = too_large("turn", by.angle, kMostTurn)) return *std::move(error);
    const auto first = composed_pose(Pose(), start);
    if (!first) return first.error();
    const Matrix from = first.value().rotation();
    Parts parts = {start,    start, centre, moved_point(start, centre), shift, by.axis,
                   by.angle, from,  0};
    if (auto fault = find_fault(parts)) return *std::move(fault);
    parts.end = pose_at(parts, 1);
    parts.end_error = largest_difference(start.rotation(), from);
    return Motion(parts);
}

Pose Motion::at(double time) const noexcept {
    const format::FloatEnvironment environment;
    if (!(time > 0)) return parts_.start;
    if (!(time < 1)) return parts_.end;
    return pose_at(parts_, time);
}

}  // namespace cdprep
