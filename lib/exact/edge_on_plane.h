// SPDX-License-Identifier: MIT
#pragma once

#include "exact/triangle_contact.h"

namespace cdprep {

/// Returns the point where the segment meets the plane of a triangle with area. The ends of the
/// segment are neither both on that plane nor both on one side of it. Each coordinate is the exact
/// one, rounded once; within 2^-45 units in the last place of a tie the rounding may go the wrong
/// way. Subnormal coordinates may be off by one unit. Never allocates. Takes microseconds.
[[nodiscard]] Double3 edge_on_plane(const Double3& from, const Double3& to,
                                    const Corners& plane) noexcept;

}  // namespace cdprep
