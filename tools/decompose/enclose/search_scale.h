// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "decompose/enclose/hull_error.h"
#include "hull/convex_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// A hull in model units that contains a hull of a search.
struct OuterHull {
    ConvexHull hull;    ///< `numbers` is empty
    double growth = 0;  ///< proved: no point is farther from the hull of the search, in model units
};

/// The map between model coordinates and the coordinates of a search.
///
/// A search forms sixth powers of lengths (TriangleTree) and keeps lengths as floats
/// (DistanceField). Far from 1, these leave the range of their type: distances become wrong or
/// infinite, and a search does not end. A mesh of usual size is searched as it is. Any other mesh
/// is divided by a power of two, so that its largest coordinate is between 1 and 2. Before that,
/// axes along which it has no extent are moved to 0, since their coordinate says nothing about its
/// size.
///
/// The map is exact for nearly all meshes. If a mesh has coordinates so different in size that some
/// lose bits, hulls and bounds are enlarged by what is lost. The way back is exact above subnormal
/// numbers. Among these, hulls and bounds are rounded outwards.
class SearchScale {
public:
    /// `positions` are one or more points, in model units, finite.
    explicit SearchScale(std::span<const Double3> positions);

    /// Returns false if the mesh is searched as it is.
    [[nodiscard]] bool is_needed() const {
        return is_needed_;
    }

    [[nodiscard]] mesh::Mesh inwards(mesh::Mesh mesh) const;
    [[nodiscard]] ConvexHull inwards(ConvexHull hull) const;
    /// Returns a length for the search, rounded. No length is larger than the largest double.
    [[nodiscard]] double inwards(double length) const;

    [[nodiscard]] OuterHull outwards(const ConvexHull& hull) const;
    /// Returns the error in model units; its bounds are rounded outwards.
    [[nodiscard]] HullError outwards(const HullError& error) const;

private:
    struct Range {
        double lower;
        double upper;
    };
    [[nodiscard]] Double3 inwards(const Double3& p) const;
    [[nodiscard]] Range outwards(double x, double shift) const;

    bool is_needed_ = false;
    int exponent_ = 0;
    Double3 shift_{};  ///< 0 along axes that are not moved
    double lost_ = 0;  ///< model units: no point of the mesh moves by more
};

}  // namespace cdprep::convex
