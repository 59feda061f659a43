// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/exact/triangles.h"
#include "crossings/arc.h"

namespace cdprep::mesh {

/// A triangle as seen from a point: the cone of all directions to it.
class SeenTriangle {
public:
    /// The eye must not be a corner. It may lie on the triangle. The cone is then a plane or
    /// more, and nothing is apart from it.
    SeenTriangle(const Double3& eye, const Corners& triangle);

    /// Returns true only if no direction to a point of the ball is a direction to a point of the
    /// triangle. False is rare for balls far from the cone in relation to their radius.
    [[nodiscard]] bool is_apart(const Double3& centre, double radius) const;

private:
    [[nodiscard]] bool separates(const Double3& normal, const Double3& centre, double radius) const;

    std::array<Double3, 3> to_;    ///< directions to the corners, of length 1
    std::array<Double3, 3> face_;  ///< outward normals of the cone's faces, of length 1 or 0
    std::array<std::array<double, 3>, 3> cosine_;  ///< between to_[i] and to_[j]
    Double3 middle_;                               ///< mean of the three directions
};

}  // namespace cdprep::mesh
