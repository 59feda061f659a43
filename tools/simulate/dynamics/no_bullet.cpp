// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled where Bullet is not installed.
#include "simulate/dynamics/rigid_bodies.h"

namespace cdprep::dynamics {

bool has_dynamics() noexcept {
    return false;
}

Result<std::unique_ptr<RigidBodies>> make_rigid_bodies(const DynamicsOptions&, ParallelFor) {
    return Error{ErrorCode::bad_argument,
                 "This program was built without Bullet, so bodies cannot move. Install "
                 "libbullet-dev and build again, or simulate without response."};
}

}  // namespace cdprep::dynamics
