// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "cells/tetra_cones.h"
#include "support/exact_rational.h"

namespace cdprep::test {

using ExactPoint = std::array<ExactRational, 3>;

/// Returns the corners of the part of the triangle that lies in the closed cone, minus the centre.
/// Clips the triangle in exact numbers at the planes through the centre and two generators each.
/// Returns no corners if nothing remains. A segment or a point counts as a polygon too.
[[nodiscard]] std::vector<ExactPoint> cut_by_cone(const Corners& t, const Double3& centre,
                                                  const TetraCone& cone);

}  // namespace cdprep::test
