// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/exact/triangles.h"

namespace cdprep::mesh {

/// Returns a common point of two triangles that meet, rounded. The point is the middle of their
/// common segment, or of their common area if they are coplanar. It always lies in the boxes of
/// both. It is meant for pictures.
[[nodiscard]] Double3 common_point(const Corners& a, const Corners& b);

}  // namespace cdprep::mesh
