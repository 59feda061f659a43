// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/model.h"
#include "cdprep/motion.h"
#include "exact/triangle_contact.h"

namespace cdprep {

/// The places and velocities of a triangle's corners along a direction.
struct Extent {
    double lowest;
    double highest;
    double slowest;
    double fastest;
    double bend;  ///< the velocity changes by this at most in a unit of time
};

/// A model and its motion: bounds of the places and velocities of its points. Velocities are in
/// model units per step.
class MovingBody {
public:
    MovingBody(const Model& model, const Motion& motion) noexcept;

    /// Returns how far a vertex that a query moves may be from the ideal path, at any time.
    [[nodiscard]] double deviation() const noexcept {
        return deviation_;
    }
    /// Returns the velocity of the centre.
    [[nodiscard]] const Double3& shift() const noexcept {
        return motion_->parts().shift;
    }
    /// Returns the greatest speed of a point relative to the centre.
    [[nodiscard]] double turning_speed() const noexcept {
        return motion_->parts().angle * radius_;
    }
    /// Returns a length that is typical of a triangle.
    [[nodiscard]] double triangle_size() const noexcept {
        return triangle_size_;
    }
    /// Returns the extent of a triangle along a unit vector. `corners` are those at this time.
    [[nodiscard]] Extent extent(const Corners& corners, const Double3& direction,
                                double time) const noexcept;

private:
    const Motion* motion_;
    double radius_;  ///< the greatest distance of a point from the axis of the turn
    double deviation_;
    double triangle_size_;
};

/// Returns a bound of the speed of any point of one body relative to the other.
[[nodiscard]] double greatest_speed(const MovingBody& a, const MovingBody& b) noexcept;

/// Returns a time during which a gap stays open. It closes at the speed `closing` now, which may be
/// negative. This speed changes by `bend` at most in a unit of time. The time is the positive h
/// with gap = closing h + bend h^2 / 2, up to some roundings. It is 0 without a gap, and infinity
/// if there is no such h.
[[nodiscard]] double time_apart(double gap, double closing, double bend) noexcept;

}  // namespace cdprep
