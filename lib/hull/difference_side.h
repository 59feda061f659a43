// SPDX-License-Identifier: MIT
#pragma once

#include "hull/nearest_simplex.h"

namespace cdprep {

/// Returns orient3d() of four corners of A - B, each a difference of two points. It is positive
/// when d lies behind the plane that shows p, q, r counter-clockwise. Exact.
[[nodiscard]] int side_of(const Difference& p, const Difference& q, const Difference& r,
                          const Difference& d) noexcept;

}  // namespace cdprep
