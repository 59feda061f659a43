// SPDX-License-Identifier: MIT
#pragma once

#include "exact/triangle_contact.h"

namespace cdprep {

/// Returns where the segment meets the plane of a triangle with area; its ends are not
/// both on that plane nor both on one side of it. Each coordinate is exact but for
/// one rounding, which may go the wrong way within 2^-45 units in the last place of a
/// tie; subnormal ones may be off by one unit. Never allocates. Takes microseconds.
[[nodiscard]] Double3 edge_on_plane(const Double3& from, const Double3& to,
                                    const Corners& plane) noexcept;

}  // namespace cdprep
