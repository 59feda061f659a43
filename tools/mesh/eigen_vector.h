// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "cdprep/format/geometry.h"

namespace cdprep::convex {

[[nodiscard]] inline Eigen::Vector3d vector_of(const format::Double3& p) {
    return {p.x, p.y, p.z};
}

}  // namespace cdprep::convex
