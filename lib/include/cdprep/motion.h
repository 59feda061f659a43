// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "cdprep/format/api.h"
#include "cdprep/pose.h"

namespace cdprep {

/// The rigid motion of one model during a step, from time 0 to time 1. One point of the model, the
/// centre, moves along a straight line at constant speed. The model turns at constant speed about a
/// fixed axis through the centre.
///
/// A good centre for a free body is its centre of mass. For a part that turns about a joint, it is
/// the joint. A centre far outside the model makes time_of_impact() slow.
class Motion {
public:
    /// No motion at all: the identity at all times.
    Motion() noexcept : Motion(Pose()) {}
    /// The motion of a model that stays at a pose.
    CDPREP_API explicit Motion(const Pose& world_from_model) noexcept;

    /// Makes the motion between two poses of the model. `centre` is a point of the model, in its
    /// own coordinates. The model turns the shorter way, by pi at most. If the turn is exactly pi,
    /// both directions are equally short. Then the model always turns the same way.
    ///
    /// Fails with bad_argument if a number of `centre` is not finite. Also fails if the centre
    /// moves farther than format::kMaxCoordinate along an axis, or if a pose might exceed this
    /// limit. Allocates only on failure.
    [[nodiscard]] CDPREP_API static Result<Motion> between(const Pose& start, const Pose& end,
                                                           const Double3& centre = {});

    /// Makes the motion from velocities, as a solver has them. `shift` is the displacement of the
    /// centre during the step, in world coordinates and model units. `turn` is a vector along the
    /// axis of the turn, in world coordinates. Its length is the angle in radians, kMostTurn at
    /// most. So a model may make more than one full turn.
    ///
    /// Fails like between(), and if `shift` or `turn` is not finite or too long.
    [[nodiscard]] CDPREP_API static Result<Motion> by_velocity(const Pose& start,
                                                               const Double3& shift,
                                                               const Double3& turn,
                                                               const Double3& centre = {});

    /// Returns the pose at a time. At 0 it is the given start, and at 1 the end given to between(),
    /// both bit for bit. Times outside [0, 1] count as the nearer end; NaN counts as 0. Uses the
    /// sine and cosine of the C library. So the last bits may differ between platforms.
    [[nodiscard]] CDPREP_API Pose at(double time) const noexcept;

    static constexpr double kMostTurn = 1000;  ///< radians

    /// The parts of a motion: x(t) = R(axis, t angle) start_rotation (p - centre) + c(t), with
    /// c(t) = start_of_centre + t shift.
    struct Parts {
        Pose start;
        Pose end;
        Double3 centre;           ///< in the model's coordinates
        Double3 start_of_centre;  ///< world
        Double3 shift;            ///< world
        Double3 axis;             ///< world, a unit vector
        double angle;             ///< radians, not negative
        /// The rotation of `start`, made orthonormal by between() and by_velocity().
        std::array<double, 9> start_rotation;
        /// The largest deviation of an entry of the rotations at 0 and 1 from this formula.
        double end_error;
    };
    [[nodiscard]] const Parts& parts() const noexcept {
        return parts_;
    }

private:
    explicit Motion(const Parts& parts) noexcept : parts_(parts) {}

    Parts parts_;
};

}  // namespace cdprep
