// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/moved_model.h"

namespace cdprep {

/// A vector in the coordinates of a model's boxes.
using FrameVector = std::array<double, 3>;

/// Transforms a shape from the world into the coordinates of a model's boxes. There the model, as
/// stored, lies within [-1, 1].
///
/// Let a stored vertex and a point of the shape be d apart in these coordinates. Their scaled
/// distance in the world is within slack() of d. Let r, s and t be the largest |coordinate| of the
/// model, the shape and the translation. Let u = 2^-53. Without a pose, transforming the shape's
/// points is off by u (r + s). Computing with them in double adds about 16 u of it. With a pose, a
/// vertex is off its place by 5 u (3 r + t) per axis. R^T replaces the inverse of R, from which it
/// differs by at most 3e-12. So a point of the shape is off by 3e-12 (s + t) sqrt 3, and lengths by
/// 2e-12 of themselves. Numbers that leave the range become infinite or NaN, and those prune
/// nothing.
class ShapeFrame {
public:
    ShapeFrame(const MovedModel& model, double shape_reach) noexcept
        : header_(model.model->header()), pose_(model.pose) {
        constexpr double kStillSlack = 0x1p-45;
        constexpr double kMovedSlack = 0x1p-35;
        const double shift = pose_ == nullptr ? 0 : largest(pose_->translation());
        const double reach =
            scaled(shape_reach) + scaled(largest(header_.frame_origin)) + scaled(shift) + 1;
        slack_ = (pose_ == nullptr ? kStillSlack : kMovedSlack) * reach;
    }

    /// Returns the slack in frame units, > 0.
    [[nodiscard]] double slack() const noexcept {
        return slack_;
    }
    [[nodiscard]] double scaled(double length) const noexcept {
        return std::ldexp(length, header_.frame_exponent);
    }
    [[nodiscard]] FrameVector at(const Double3& p) const noexcept {
        const Double3 local = pose_ == nullptr ? p : turned_back(p);
        const Double3& o = header_.frame_origin;
        return {scaled(local.x - o.x), scaled(local.y - o.y), scaled(local.z - o.z)};
    }

    [[nodiscard]] static double largest(const Double3& p) noexcept {
        return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }

private:
    [[nodiscard]] Double3 turned_back(const Double3& p) const noexcept {
        const std::array<double, 9>& r = pose_->rotation();
        const Double3& t = pose_->translation();
        const double x = p.x - t.x, y = p.y - t.y, z = p.z - t.z;
        return {r[0] * x + r[3] * y + r[6] * z, r[1] * x + r[4] * y + r[7] * z,
                r[2] * x + r[5] * y + r[8] * z};
    }

    const format::FileHeader& header_;
    const Pose* pose_;
    double slack_;
};

}  // namespace cdprep
