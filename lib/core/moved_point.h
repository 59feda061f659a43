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

}  // namespace cdprep
