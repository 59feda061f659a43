// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

#include "build/lanes.h"
#include "cdprep/format/api.h"
#include "cdprep/format/geometry.h"
#include "exact/vectors.h"

namespace cdprep::build {

using Vector = std::array<double, 3>;
using Doubles = Lanes<double, format::kBvhWidth>;

/// Rows and columns of a symmetric matrix stored as xx, yy, zz, xy, yz, zx.
inline constexpr std::array<std::size_t, 6> kRow = {0, 1, 2, 0, 1, 2};
inline constexpr std::array<std::size_t, 6> kColumn = {0, 1, 2, 1, 2, 0};

/// Adds in pairs, so that half of a vector is added to the other.
template <class T>
T sum_of(Lanes<T, format::kBvhWidth> lanes) {
    for_lanes<4>([&](std::size_t lane) { lanes[lane] += lanes[lane + 4]; });
    return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

/// Area, its middle, and the integral of (x - middle) (x - middle)^T, in frame coordinates.
struct Moments {
    double area = 0;
    Vector middle{};
    std::array<double, 6> second{};
};

/// The moments of eight surfaces.
struct MomentLanes {
    Doubles area{};
    std::array<Doubles, 3> middle{};
    std::array<Doubles, 6> second{};

    void set(std::size_t lane, const Moments& moments) {
        assert(lane < format::kBvhWidth);
        area[lane] = moments.area;
        for (std::size_t i = 0; i < 3; ++i) middle[i][lane] = moments.middle[i];
        for (std::size_t i = 0; i < 6; ++i) second[i][lane] = moments.second[i];
    }
};

/// Returns the moments of eight surfaces together (Steiner).
[[nodiscard]] CDPREP_API Moments sum_of(const MomentLanes& lanes);

/// Orthonormal axes rounded to float; the third is their cross product.
struct Axes {
    std::array<std::array<float, 3>, 2> stored;
    std::array<Vector, 3> used;
};

using NodeAxes = std::array<Axes, format::kBvhWidth>;

/// Returns the axes of eight surfaces, with every part weighted by its area. The direction of least
/// extent comes first, then that of middle extent. For a surface without area, they are x and y.
[[nodiscard]] CDPREP_API NodeAxes axes_of(const MomentLanes& moments);

/// The extents of an object along three axes, relative to a point.
struct Reach {
    Vector lower;
    Vector upper;
};

/// Writes the box of an object with this reach from `origin`, in frame coordinates. Its half
/// extents are enlarged by `slack`, by 2^-17 of the largest and by the rounding of the centre.
CDPREP_API void write_box(const Vector& origin, const Axes& axes, const Reach& reach, double slack,
                          format::OrientedNode& node, std::size_t box);

/// Marks the box as unused.
CDPREP_API void write_no_box(format::OrientedNode& node, std::size_t box);

}  // namespace cdprep::build
