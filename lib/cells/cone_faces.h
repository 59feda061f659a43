// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cells/tetra_cones.h"

// A direction turned into the positive octant is (x, y, z) >= 0 with the sum s. Its place on the
// octahedron's face is (x, y, z) / s. The lines that split the face are parallel to its edges. So
// the planes of a cone of level l are 2^l x_axis = m s, three with three axes and whole m. A point
// p lies in the closed cone when f(p) = side (x_axis - m / 2^l s) is not negative for any of them.
// f is linear in p, also outside the octant.

namespace cdprep {

/// One plane of a cone, with the function `side` (x_axis - weight * s), which is not negative
/// inside.
struct ConeFace {
    std::size_t axis;
    std::int32_t steps;  ///< weight * 2^level
    double weight;       ///< 0 to 1
    double side;         ///< 1 or -1
};

/// face[k] is across from generator k.
struct ConeFaces {
    std::array<ConeFace, 3> face;
    std::array<double, 3> sign;  ///< of the octant: 1 or -1
    std::int32_t steps;          ///< 2^level
};

[[nodiscard]] ConeFaces cone_faces(const TetraCone& cone) noexcept;

/// A point seen from the centre, in double.
struct SeenPoint {
    std::array<double, 3> at;  ///< p - C times a power of two
    double size;               ///< sum of the sizes
};

/// The size below which differences are left to exact numbers, beside a triangle or model of about
/// 1. Nothing computed from larger differences underflows.
inline constexpr double kLeastSeen = 0x1p-900;

/// Returns a bound of the rounding error of f or s. It also bounds either of them times a few units
/// in the last place. Each difference is off by a factor 1 + u, u = 2^-53. s is off by 3.1 u of
/// `size`, m s by 4.2 u and x by 1 u. Their difference, at most 2 size, adds 2 u: 7.3 u. `size`
/// itself is off by 3 u of it. A factor that is a power of two adds nothing above kLeastSeen.
[[nodiscard]] inline double slack_of(const SeenPoint& p) noexcept {
    return 0x1p-50 * p.size + kLeastSeen;
}

[[nodiscard]] inline SeenPoint seen_point(const Double3& centre, const Double3& p,
                                          double scale) noexcept {
    const std::array<double, 3> at = {(p.x - centre.x) * scale, (p.y - centre.y) * scale,
                                      (p.z - centre.z) * scale};
    return {at, std::fabs(at[0]) + std::fabs(at[1]) + std::fabs(at[2])};
}

using SeenTriangle = std::array<SeenPoint, 3>;

[[nodiscard]] inline SeenTriangle seen_triangle(const Double3& centre, const Corners& t,
                                                double scale) noexcept {
    return {seen_point(centre, t[0], scale), seen_point(centre, t[1], scale),
            seen_point(centre, t[2], scale)};
}

/// Returns s of a point, in the octant of these signs.
[[nodiscard]] inline double sum_in(const std::array<double, 3>& sign, const SeenPoint& p) noexcept {
    return sign[0] * p.at[0] + sign[1] * p.at[1] + sign[2] * p.at[2];
}

/// The rounded values of f for each face and corner.
struct FaceValues {
    std::array<std::array<double, 3>, 3> at;  ///< [face][corner]
    std::array<double, 3> slack;              ///< [corner]: f is off by less
};

[[nodiscard]] inline FaceValues face_values(const ConeFaces& faces,
                                            const SeenTriangle& t) noexcept {
    FaceValues f;
    for (std::size_t i = 0; i < 3; ++i) {
        const double sum = sum_in(faces.sign, t[i]);
        f.slack[i] = slack_of(t[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const ConeFace& face = faces.face[k];
            f.at[k][i] =
                face.side * (faces.sign[face.axis] * t[i].at[face.axis] - face.weight * sum);
        }
    }
    return f;
}

/// Returns triangle_touches_cone() from values that are already known. `f` is face_values() of the
/// same triangle and cone, with any scale.
[[nodiscard]] bool touches_faces(const Corners& t, const Double3& centre, const ConeFaces& faces,
                                 const FaceValues& f) noexcept;

}  // namespace cdprep
