// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

// Rounded, operation by operation.

[[nodiscard]] inline format::Double3 minus(const format::Double3& a, const format::Double3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

[[nodiscard]] inline double dot(const format::Double3& a, const format::Double3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[nodiscard]] inline format::Double3 cross(const format::Double3& a, const format::Double3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace cdprep::mesh
