// SPDX-License-Identifier: MIT
#include "cdprep/pose.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "cdprep/format/float_environment.h"
#include "moved_point.h"

namespace cdprep {
namespace {

std::string shown(double number) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.17g", number);
    return text.data();
}

/// The entry of R^T R - I that is farthest from zero.
double worst_rotation_error(const std::array<double, 9>& r) {
    double worst = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j) {
            const double product = r[i] * r[j] + r[3 + i] * r[3 + j] + r[6 + i] * r[6 + j];
            worst = std::max(worst, std::fabs(product - (i == j ? 1.0 : 0.0)));
        }
    }
    return worst;
}

double determinant(const std::array<double, 9>& r) {
    return r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
           r[2] * (r[3] * r[7] - r[4] * r[6]);
}

Error bad_pose(std::string message) {
    return {ErrorCode::bad_argument, std::move(message)};
}

}  // namespace

Result<Pose> Pose::from_rows(const std::array<double, 12>& rows) {
    const format::FloatEnvironment environment;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!std::isfinite(rows[i])) {
            return bad_pose("Number " + std::to_string(i + 1) + " of the pose is " +
                            shown(rows[i]) + "; all twelve must be finite.");
        }
        if (std::fabs(rows[i]) > format::kMaxCoordinate) {
            return bad_pose("Number " + std::to_string(i + 1) + " of the pose is " +
                            shown(rows[i]) + "; at most " + shown(format::kMaxCoordinate) +
                            " is allowed.");
        }
    }
    Pose pose;
    std::copy_n(rows.begin(), 9, pose.rotation_.begin());
    pose.translation_ = {rows[9], rows[10], rows[11]};
    const double error = worst_rotation_error(pose.rotation_);
    if (!(error <= kRotationTolerance)) {
        return bad_pose("The pose does not turn rigidly: |R^T R - I| reaches " + shown(error) +
                        ", allowed is " + shown(kRotationTolerance) + ".");
    }
    if (determinant(pose.rotation_) < 0) {
        return bad_pose("The pose mirrors: the determinant of R is -1, but only 1 is a rotation.");
    }
    return pose;
}

Result<Pose> Pose::from_quaternion(double w, double x, double y, double z,
                                   const Double3& translation) {
    const format::FloatEnvironment environment;
    const double largest = std::max({std::fabs(w), std::fabs(x), std::fabs(y), std::fabs(z)});
    if (!std::isfinite(w) || !std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
        return bad_pose("The quaternion of the pose holds " + shown(w) + ", " + shown(x) + ", " +
                        shown(y) + ", " + shown(z) + "; all four must be finite.");
    }
    if (largest == 0) {
        return bad_pose("The quaternion of the pose is zero; it must have a direction.");
    }
    // A power of two keeps the squares in range and changes no digit.
    const int exponent = -std::ilogb(largest);
    w = std::scalbn(w, exponent);
    x = std::scalbn(x, exponent);
    y = std::scalbn(y, exponent);
    z = std::scalbn(z, exponent);
    const double s = 2 / (w * w + x * x + y * y + z * z);
    return from_rows({1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
                      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),
                      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y),
                      translation.x, translation.y, translation.z});
}

Pose relative_pose(const Pose& world_from_a, const Pose& world_from_b) noexcept {
    const format::FloatEnvironment environment;
    const std::array<double, 9>& a = world_from_a.rotation_;
    const std::array<double, 9>& b = world_from_b.rotation_;
    const Double3 d = {world_from_b.translation_.x - world_from_a.translation_.x,
                       world_from_b.translation_.y - world_from_a.translation_.y,
                       world_from_b.translation_.z - world_from_a.translation_.z};
    Pose relative;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            relative.rotation_[3 * i + j] =
                (a[i] * b[j] + a[3 + i] * b[3 + j]) + a[6 + i] * b[6 + j];
        }
    }
    relative.translation_ = {(a[0] * d.x + a[3] * d.y) + a[6] * d.z,
                             (a[1] * d.x + a[4] * d.y) + a[7] * d.z,
                             (a[2] * d.x + a[5] * d.y) + a[8] * d.z};
    return relative;
}

Double3 moved(const Pose& pose, const Double3& p) noexcept {
    const format::FloatEnvironment environment;
    return moved_point(pose, p);
}

}  // namespace cdprep
