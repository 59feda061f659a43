// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// What normalize() did: v' = (v - offset) * (1 / diagonal), as floats.
struct Normalization {
    Double3 offset{};
    double factor = 0;  ///< 1 / diagonal
};

/// Fits the soup to a box whose diagonal is 1, centred: the box of the vertices
/// that triangles use, in double, then each coordinate rounded to a float. A
/// soup without extent, or of less than 2^-1022, is only centred. Coordinates are
/// at most format::kMaxCoordinate. Afterwards single_precision holds.
Normalization normalize(TriangleSoup& soup);

}  // namespace cdprep::mesh
