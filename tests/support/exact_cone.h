// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cells/tetra_cones.h"
#include "support/exact_rational.h"

namespace cdprep::test {

using ExactPoint = std::array<ExactRational, 3>;

/// What of the triangle lies in the closed cone, less the centre: the corners of the
/// polygon that is left when the triangle is cut at the planes through the centre and two
/// generators each, in exact numbers; none when nothing is left. A segment or a point is a
/// polygon too.
[[nodiscard]] std::vector<ExactPoint> cut_by_cone(const Corners& t, const Double3& centre,
                                                  const TetraCone& cone);

}  // namespace cdprep::test
