// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/seen_triangle.h"

#include "mesh/vectors.h"

// Cone and ball are apart if and only if some plane through the eye separates them. The
// directions of the cone lie strictly below it, and the ball lies above it. The best normal
// points from the nearest point of the cone to the centre of the ball. That point lies on a face
// or an edge of the cone, or is the eye. is_apart() tries the normals of these seven cases.
// separates() then proves the separation, whatever the normal is. The error of directions is
// less than kDirectionMargin, and a normal may be any vector.

namespace cdprep::mesh {
namespace {

/// Returns the vector with length 1; unchanged if its length is close to zero.
Double3 normalized(const Double3& p) {
    const double length = std::sqrt(dot(p, p));
    return length > kDirectionMargin ? scaled(p, 1 / length) : p;
}

}  // namespace

SeenTriangle::SeenTriangle(const Double3& eye, const Corners& triangle) : cosine_{} {
    for (std::size_t i = 0; i < 3; ++i) to_[i] = direction(eye, triangle[i]);
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3 face = normalized(cross(to_[i], to_[(i + 1) % 3]));
        face_[i] = dot(face, to_[(i + 2) % 3]) > 0 ? scaled(face, -1) : face;
        for (std::size_t j = 0; j < 3; ++j) cosine_[i][j] = dot(to_[i], to_[j]);
    }
    middle_ = scaled(plus(plus(to_[0], to_[1]), to_[2]), 1.0 / 3);
}

bool SeenTriangle::is_apart(const Double3& centre, double radius) const {
    const std::array<double, 3> along = {dot(centre, to_[0]), dot(centre, to_[1]),
                                         dot(centre, to_[2])};
    for (const Double3& face : face_) {
        if (dot(face, centre) > radius && separates(face, centre, radius)) return true;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const bool others_below = along[j] <= along[i] * cosine_[i][j] + kDirectionMargin &&
                                  along[k] <= along[i] * cosine_[i][k] + kDirectionMargin;
        if (!others_below || along[i] < 0) continue;
        const Double3 away = minus(centre, scaled(to_[i], along[i]));
        if (separates(normalized(away), centre, radius)) return true;
    }
    return along[0] <= 0 && along[1] <= 0 && along[2] <= 0 &&
           separates(normalized(centre), centre, radius);
}

bool SeenTriangle::separates(const Double3& normal, const Double3& centre, double radius) const {
    const double gap = dot(normal, centre) - radius;
    if (!(gap > 0)) return false;
    // Edges of the cone may lie in the plane of the nearest point, so it is tilted away from
    // them.
    const Double3 tilted = minus(normal, scaled(middle_, gap / 4));
    for (const Double3& to : to_) {
        if (!(dot(tilted, to) < -kDirectionMargin)) return false;
    }
    const double length = std::sqrt(dot(tilted, tilted));
    return dot(tilted, centre) > (radius + kDirectionMargin) * length;
}

}  // namespace cdprep::mesh
