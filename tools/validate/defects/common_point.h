// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/exact/triangles.h"

namespace cdprep::mesh {

/// Returns a point that two triangles that meet have in common, rounded: the middle of their
/// common segment, or of the area they share in a plane. For pictures; in their boxes at any
/// rate.
[[nodiscard]] Double3 common_point(const Corners& a, const Corners& b);

}  // namespace cdprep::mesh
