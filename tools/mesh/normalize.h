// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// The map that normalize() applied: v' = (v - offset) * (1 / diagonal), as floats.
struct Normalization {
    Double3 offset{};
    double factor = 0;  ///< 1 / diagonal
};

/// Centres the soup and scales it to a box whose diagonal is 1. Computes the box of the vertices
/// that triangles use, in double, then rounds each coordinate to a float. A soup without extent,
/// or with one below 2^-1022, is only centred. Coordinates must be at most
/// format::kMaxCoordinate. Afterwards single_precision holds, and the unit is unknown: a length is
/// then a share of the diagonal.
Normalization normalize(TriangleSoup& soup);

}  // namespace cdprep::mesh
