// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/pose.h"
#include "simulate/dynamics/body_mass.h"

namespace cdprep::dynamics {

/// Where a rigid body is.
struct RigidState {
    Double3 centre{};                           ///< of mass, in the world
    std::array<double, 4> turn = {1, 0, 0, 0};  ///< w x y z: from the model's axes to the world's
};

/// Returns the state of a model with its centre of mass at `centre`, in model coordinates.
[[nodiscard]] RigidState state_of(const Pose& world_from_model, const Double3& centre) noexcept;

/// Returns the pose of a model. Fails with bad_argument if it is beyond the range of coordinates.
[[nodiscard]] Result<Pose> pose_of(const RigidState& state, const Double3& centre);

/// Returns the state after a shift and a turn about the centre. `turn` is along the axis, and as
/// long as the angle.
[[nodiscard]] RigidState moved(const RigidState& state, const Double3& shift,
                               const Double3& turn) noexcept;

/// A body after some time without torque.
struct FreeMotion {
    RigidState state;
    Double3 spin;  ///< radians per second, in the world
};

/// Moves a body by a shift and turns it freely. `push` is a turn in addition, which is no velocity:
/// as long as its angle. The angular momentum stays, up to rounding. `seconds` must be at most
/// kMostSpinChange / most_spin_change(). Euler's equations are solved by the implicit midpoint
/// rule, composed to the fourth order (Hairer, Lubich and Wanner, Geometric Numerical Integration,
/// II.4 and VII.5).
[[nodiscard]] FreeMotion moved_freely(const BodyMass& mass, const RigidState& state,
                                      const Double3& shift, const Double3& spin,
                                      const Double3& push, double seconds) noexcept;

/// Returns a bound of the angular velocity of a free body at all times. It follows from the energy
/// and the angular momentum, which stay.
[[nodiscard]] double most_spin(const BodyMass& mass, const RigidState& state,
                               const Double3& spin) noexcept;

/// Returns a bound of the change of a free body's spin, in radians per second, for each radian that
/// the body turns.
[[nodiscard]] double most_spin_change(const BodyMass& mass, const RigidState& state,
                                      const Double3& spin) noexcept;
inline constexpr double kMostSpinChange = 0.25;

/// Returns R p for a rotation, row by row.
[[nodiscard]] inline Double3 rotated(const std::array<double, 9>& r, const Double3& p) noexcept {
    return {r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
            r[6] * p.x + r[7] * p.y + r[8] * p.z};
}

}  // namespace cdprep::dynamics
