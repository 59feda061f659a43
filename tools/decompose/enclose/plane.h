// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/vectors.h"

namespace cdprep::convex {

using format::Double3;

struct Plane {
    Double3 normal;  ///< of length 1; 0 if there is no direction
    double offset;
};

[[nodiscard]] inline double height(const Plane& plane, const Double3& p) {
    return mesh::dot(plane.normal, p) - plane.offset;
}

}  // namespace cdprep::convex
