// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/overlapping_triangles.h"
#include "cdprep/pose.h"
#include "cdprep/visitor.h"

namespace cdprep {

/// What the questions about a model and one shape share: touching_box.h,
/// touching_sphere.h, touching_capsule.h, touching_triangle.h.
///
/// Each shape is closed and solid: touching counts, and so does a triangle that lies
/// inside. The model is its surface: a shape deep within a closed model touches
/// nothing; points_inside() answers for a point of it.
struct TouchOptions {
    /// Where the model stands: the shape's coordinates are the world's. Every vertex is
    /// moved once, by transform_point(), and the answer is exact for the resulting doubles (level
    /// E1); the identity moves nothing. Where the shape is what moves and the answer is
    /// to be exact for the vertices as stored, give the shape in model coordinates.
    Pose world_from_model = {};
    Degenerate degenerate = Degenerate::keep;
};

/// Called with the imported file's number of a triangle.
using TriangleVisitor = Visitor<std::uint32_t>;

}  // namespace cdprep
