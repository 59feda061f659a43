// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_points.h"

#include "cdprep/format/float_environment.h"
#include "hull/hull_points.h"

namespace cdprep {

Double3 ConvexPoints::point(std::uint32_t number) const noexcept {
    const format::FloatEnvironment environment;
    return hull_point(*this, number);
}

std::uint32_t direction_cell(const Double3& direction) noexcept {
    const format::FloatEnvironment environment;
    return cell_of_direction(direction);
}

}  // namespace cdprep
