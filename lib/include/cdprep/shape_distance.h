// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// How far a shape is from a surface, and where.
struct ShapeDistance {
    double lower;            ///< the distance is at least this, model units
    double upper;            ///< and at most this: [lower, upper] holds the exact one
    Double3 on_model;        ///< of the surface as moved, up to rounding; nearest to the shape
    Double3 on_shape;        ///< of the triangle or, for a capsule, of its segment
    std::uint32_t triangle;  ///< that on_model lies on; the imported file's number
};

/// What shall be measured. The interval holds the distance to the vertices as moved
/// (level E1). It is at most 1e-12 of the distance plus 1e-15 of the largest coordinate
/// wide; a capsule's is that of its segment, and 4 ulp more for taking the radius off.
/// Of triangles with equal `upper` the one with the lowest number answers; of those that are
/// equally near in exact numbers any may, and always the same.
struct ShapeDistanceOptions {
    Pose world_from_model = {};  ///< where the model stands, as in TouchOptions
    /// Beyond, nothing is of interest; inclusive.
    double max_distance = std::numeric_limits<double>::infinity();
};

}  // namespace cdprep
