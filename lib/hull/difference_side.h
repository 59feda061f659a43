// SPDX-License-Identifier: MIT
#pragma once

#include "hull/nearest_simplex.h"

namespace cdprep {

/// orient3d() of four corners of A - B, which are differences of two points each: positive
/// when d lies behind the plane that shows p, q, r counter-clockwise. Exact.
[[nodiscard]] int side_of(const Difference& p, const Difference& q, const Difference& r,
                          const Difference& d) noexcept;

}  // namespace cdprep
