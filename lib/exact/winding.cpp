// SPDX-License-Identifier: MIT
#include "exact/winding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/predicates.h"
#include "exact/triangle_contact.h"
#include "exact/vectors.h"

namespace cdprep {
namespace {

/// Returns the sign of orient3d(o', q, a, b) for the perturbed o'. The determinant is linear in its
/// first point, with the gradient (q - b) x (a - b). The gradient's components are planar
/// determinants.
int perturbed_sign(const Double3& o, const Double3& q, const Double3& a, const Double3& b) {
    if (const int sign = orient3d(o, q, a, b); sign != 0) return sign;
    if (const int sign = orient2d({q.y, q.z}, {a.y, a.z}, {b.y, b.z}); sign != 0) return sign;
    if (const int sign = orient2d({q.z, q.x}, {a.z, a.x}, {b.z, b.x}); sign != 0) return sign;
    return orient2d({q.x, q.y}, {a.x, a.y}, {b.x, b.y});
}

Double3 scaled_difference(const Double3& a, const Double3& b, int exponent) {
    return {std::ldexp(a.x - b.x, exponent), std::ldexp(a.y - b.y, exponent),
            std::ldexp(a.z - b.z, exponent)};
}

double largest(const Double3& p) {
    return std::fmax(std::fabs(p.x), std::fmax(std::fabs(p.y), std::fabs(p.z)));
}

}  // namespace

WindingTerm winding_term(const Double3& o, const Double3& q, const Corners& t) noexcept {
    const int side = orient3d(t[0], t[1], t[2], q);
    if (side == 0) {
        // q lies in the triangle's plane, or the triangle defines no plane.
        return {0, triangles_touch({q, q, q}, t)};
    }
    const int turn = perturbed_sign(o, q, t[0], t[1]);
    if (turn == 0 || turn != perturbed_sign(o, q, t[1], t[2]) ||
        turn != perturbed_sign(o, q, t[2], t[0])) {
        return {0, false};
    }
    // The line pierces the triangle. It does so beyond q if the signs differ.
    return {side != turn ? side : 0, false};
}

Double3 before_along_x(const Double3& q, double reach) noexcept {
    const double x = q.x - 2 * std::max(std::fabs(q.x), reach);
    return {std::max(x, std::numeric_limits<double>::lowest()), q.y, q.z};
}

double solid_angle(const Double3& q, const Corners& t) noexcept {
    const double size = std::fmax(
        std::fmax(largest(scaled_difference(t[0], q, 0)), largest(scaled_difference(t[1], q, 0))),
        largest(scaled_difference(t[2], q, 0)));
    if (size == 0) return 0;
    // Scaling by a power of two keeps the triple product in range and changes no digit.
    const int exponent = -std::ilogb(size);
    const Double3 a = scaled_difference(t[0], q, exponent);
    const Double3 b = scaled_difference(t[1], q, exponent);
    const Double3 c = scaled_difference(t[2], q, exponent);
    const double la = std::sqrt(dot(a, a));
    const double lb = std::sqrt(dot(b, b));
    const double lc = std::sqrt(dot(c, c));
    const double volume = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                          a.z * (b.x * c.y - b.y * c.x);
    const double angle = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return volume == 0 ? 0 : 2 * std::atan2(volume, angle);
}

}  // namespace cdprep
