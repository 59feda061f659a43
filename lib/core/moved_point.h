// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/pose.h"

namespace cdprep {

/// As transform_point(), for the code inside queries: inline, and in the floating-point environment
/// that the query has set. Public headers contain no arithmetic, because a caller's compiler could
/// contract it.
[[nodiscard]] inline Double3 moved_point(const Pose& pose, const Double3& p) noexcept {
    const std::array<double, 9>& r = pose.rotation();
    const Double3& t = pose.translation();
    return {((r[0] * p.x + r[1] * p.y) + r[2] * p.z) + t.x,
            ((r[3] * p.x + r[4] * p.y) + r[5] * p.z) + t.y,
            ((r[6] * p.x + r[7] * p.y) + r[8] * p.z) + t.z};
}

/// Returns a direction turned into the coordinates of what `pose` moves; null: nothing moves it.
[[nodiscard]] inline Double3 turned_back(const Pose* pose, const Double3& d) noexcept {
    if (pose == nullptr) return d;
    const std::array<double, 9>& r = pose->rotation();
    return {(r[0] * d.x + r[3] * d.y) + r[6] * d.z, (r[1] * d.x + r[4] * d.y) + r[7] * d.z,
            (r[2] * d.x + r[5] * d.y) + r[8] * d.z};
}

}  // namespace cdprep
