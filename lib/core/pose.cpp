// SPDX-License-Identifier: MIT
#include "cdprep/pose.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

#include "cdprep/format/float_environment.h"
#include "core/moved_point.h"
#include "core/number_text.h"
#include "core/uncorrected_relative_pose.h"

namespace cdprep {
namespace {

/// Returns the size of the entry of R^T R - I that is farthest from zero.
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
    return checked(rows);
}

Result<Pose> Pose::checked(const std::array<double, 12>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!std::isfinite(rows[i])) {
            return bad_pose("Number " + std::to_string(i + 1) + " of the pose is " +
                            number_text(rows[i]) + "; all twelve must be finite.");
        }
        if (std::fabs(rows[i]) > format::kMaxCoordinate) {
            return bad_pose("Number " + std::to_string(i + 1) + " of the pose is " +
                            number_text(rows[i]) + "; at most " +
                            number_text(format::kMaxCoordinate) + " is allowed.");
        }
    }
    Pose pose;
    std::copy_n(rows.begin(), 9, pose.rotation_.begin());
    pose.translation_ = {rows[9], rows[10], rows[11]};
    const double error = worst_rotation_error(pose.rotation_);
    if (!(error <= kRotationTolerance)) {
        return bad_pose("The pose scales or shears: R^T R differs from the identity by " +
                        number_text(error) + "; at most " + number_text(kRotationTolerance) +
                        " is allowed.");
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
        return bad_pose("The quaternion of the pose holds " + number_text(w) + ", " +
                        number_text(x) + ", " + number_text(y) + ", " + number_text(z) +
                        "; all four must be finite.");
    }
    if (largest == 0) {
        return bad_pose("The quaternion of the pose is zero; it must have a direction.");
    }
    // Scaling by a power of two keeps the squares in range and changes no digit.
    const int exponent = -std::ilogb(largest);
    w = std::scalbn(w, exponent);
    x = std::scalbn(x, exponent);
    y = std::scalbn(y, exponent);
    z = std::scalbn(z, exponent);
    const double s = 2 / (w * w + x * x + y * y + z * z);
    return checked({1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
                    s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),
                    s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y),
                    translation.x, translation.y, translation.z});
}

Double3 transform_point(const Pose& pose, const Double3& p) noexcept {
    const format::FloatEnvironment environment;
    return moved_point(pose, p);
}

namespace {

/// A product or a transpose that is farther from a rotation than this is corrected.
constexpr double kDrift = 1e-13;

/// Returns the entry of R^T R - I in row i and column j.
double gram_error(const std::array<double, 9>& r, std::size_t i, std::size_t j) {
    return (r[i] * r[j] + r[3 + i] * r[3 + j]) + r[6 + i] * r[6 + j] - (i == j ? 1.0 : 0.0);
}

/// Returns the inverse of the transpose: cofactors over the determinant.
std::array<double, 9> inverse_transpose(const std::array<double, 9>& m) {
    const double d = determinant(m);
    assert(d > 0);
    std::array<double, 9> inverse{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t row = 3 * ((i + 1) % 3), next_row = 3 * ((i + 2) % 3);
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t column = (j + 1) % 3, next = (j + 2) % 3;
            inverse[3 * i + j] =
                (m[row + column] * m[next_row + next] - m[row + next] * m[next_row + column]) / d;
        }
    }
    return inverse;
}

/// Returns the rotation of the polar decomposition of M by Newton's iteration X <- (X + X^-T) / 2
/// (Higham, 1986). The singular values converge to 1 quadratically. Within kGreatestPoseTolerance
/// of a rotation they are at least 1/2 at first, and six steps reach the rounding of double.
std::array<double, 9> nearest_rotation(std::array<double, 9> m) {
    constexpr int kMostSteps = 10;
    for (int step = 0; step < kMostSteps; ++step) {
        const std::array<double, 9> inverse = inverse_transpose(m);
        double change = 0;
        for (std::size_t i = 0; i < 9; ++i) {
            const double next = 0.5 * (m[i] + inverse[i]);
            change = std::max(change, std::fabs(next - m[i]));
            m[i] = next;
        }
        if (change <= 0x1p-52) break;
    }
    assert(worst_rotation_error(m) <= Pose::kRotationTolerance);
    return m;
}

Result<Pose> rigid_pose(std::array<double, 9> r, const Double3& t) {
    if (worst_rotation_error(r) > kDrift) r = nearest_rotation(r);
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x, t.y, t.z});
}

/// Returns why a 3 x 3 matrix is not a rotation, or an empty string. Rejects products that overflow
/// too.
std::string defect_of(const std::array<double, 9>& m, double tolerance) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double error = gram_error(m, i, i);
        if (std::fabs(error) <= tolerance) continue;
        return "The matrix scales: the squared length of column " + std::to_string(i + 1) + " is " +
               number_text(error + 1) + ", but may differ from 1 by " + number_text(tolerance) +
               " at most.";
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double error = gram_error(m, std::min(i, j), std::max(i, j));
        if (std::fabs(error) <= tolerance) continue;
        return "The matrix shears: the product of columns " + std::to_string(std::min(i, j) + 1) +
               " and " + std::to_string(std::max(i, j) + 1) + " is " + number_text(error) +
               ", but may differ from 0 by " + number_text(tolerance) + " at most.";
    }
    if (determinant(m) > 0) return {};
    return "The matrix mirrors: its determinant is negative, and no rotation is near it.";
}

}  // namespace

Pose relative_pose(const Pose& world_from_a, const Pose& world_from_b) noexcept {
    const format::FloatEnvironment environment;
    Pose relative = uncorrected_relative_pose(world_from_a, world_from_b);
    if (worst_rotation_error(relative.rotation_) > Pose::kRotationTolerance) {
        relative.rotation_ = nearest_rotation(relative.rotation_);
    }
    return relative;
}

Pose uncorrected_relative_pose(const Pose& world_from_a, const Pose& world_from_b) noexcept {
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

Result<Pose> composed_pose(const Pose& a_from_b, const Pose& b_from_c) {
    const format::FloatEnvironment environment;
    const std::array<double, 9>& a = a_from_b.rotation();
    const std::array<double, 9>& b = b_from_c.rotation();
    std::array<double, 9> product{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            product[3 * i + j] =
                (a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j]) + a[3 * i + 2] * b[6 + j];
        }
    }
    return rigid_pose(product, transform_point(a_from_b, b_from_c.translation()));
}

Result<Pose> inverse_pose(const Pose& a_from_b) {
    const format::FloatEnvironment environment;
    const std::array<double, 9>& r = a_from_b.rotation();
    const Double3& t = a_from_b.translation();
    return rigid_pose(
        {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]},
        {0 - ((r[0] * t.x + r[3] * t.y) + r[6] * t.z), 0 - ((r[1] * t.x + r[4] * t.y) + r[7] * t.z),
         0 - ((r[2] * t.x + r[5] * t.y) + r[8] * t.z)});
}

Result<Pose> nearest_pose(const std::array<double, 16>& matrix, double tolerance,
                          MatrixLayout layout) {
    const format::FloatEnvironment environment;
    if (!(tolerance >= 0 && tolerance <= kGreatestPoseTolerance)) {
        return bad_pose("The tolerance of a pose is " + number_text(tolerance) +
                        "; it must be 0 to " + number_text(kGreatestPoseTolerance) + ".");
    }
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        if (std::fabs(matrix[i]) <= format::kMaxCoordinate) continue;
        return bad_pose("Number " + std::to_string(i + 1) + " of the matrix is " +
                        number_text(matrix[i]) + "; at most " +
                        number_text(format::kMaxCoordinate) + " is allowed.");
    }
    const auto at = [&](std::size_t row, std::size_t column) {
        return matrix[layout == MatrixLayout::rows ? 4 * row + column : 4 * column + row];
    };
    for (std::size_t column = 0; column < 4; ++column) {
        if (std::fabs(at(3, column) - (column == 3 ? 1.0 : 0.0)) <= tolerance) continue;
        return bad_pose("The matrix projects: its last row must be 0 0 0 1, but number " +
                        std::to_string(column + 1) + " of it is " + number_text(at(3, column)) +
                        ".");
    }
    const std::array<double, 9> m = {at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(1, 1),
                                     at(1, 2), at(2, 0), at(2, 1), at(2, 2)};
    if (std::string defect = defect_of(m, tolerance); !defect.empty()) {
        return bad_pose(std::move(defect));
    }
    const std::array<double, 9> r = nearest_rotation(m);
    return Pose::from_rows(
        {r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], at(0, 3), at(1, 3), at(2, 3)});
}

}  // namespace cdprep
