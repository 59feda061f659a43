// SPDX-License-Identifier: MIT
#include "build/oriented_axes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

// The axes are the eigenvectors of the covariance of a surface (Gottschalk, Lin and Manocha 1996,
// without their convex hull). Every triangle is weighted by its area. So they do not depend on how
// finely a part is tessellated. Eight are computed side by side.

namespace cdprep::build {
namespace {

using format::kBvhWidth;

using Floats = Lanes<float, kBvhWidth>;

/// Eight symmetric matrices and, after `turn`, their eigenvectors.
struct Eigen {
    std::array<std::array<Floats, 3>, 3> m;  ///< [row][column]
    std::array<std::array<Floats, 3>, 3> v;  ///< v[k]: k-th vector
};

/// Performs a Jacobi rotation that makes m[i][j] zero, without a branch (Golub and Van Loan 8.5).
/// With d = m_jj - m_ii, tan = 2 m_ij / (d +- sqrt(d^2 + 4 m_ij^2)).
void turn(Eigen& e, std::size_t i, std::size_t j) {
    assert(i < j && j < 3);
    const std::size_t other = 3 - i - j;
    Floats c;
    Floats s;
    Floats moved;
    for_lanes<8>([&](std::size_t k) {
        const float off = 2 * e.m[i][j][k];
        const float d = e.m[j][j][k] - e.m[i][i][k];
        const float root = std::sqrt(d * d + off * off);
        const float size = std::fabs(d) + root + std::numeric_limits<float>::min();
        const float t = (d < 0 ? -off : off) / size;
        c[k] = 1 / std::sqrt(t * t + 1);
        s[k] = t * c[k];
        moved[k] = 0.5F * t * off;
    });
    for_lanes<8>([&](std::size_t k) { e.m[i][i][k] -= moved[k]; });
    for_lanes<8>([&](std::size_t k) { e.m[j][j][k] += moved[k]; });
    e.m[i][j].fill(0);
    // Only the upper half is stored.
    Floats& x = e.m[std::min(i, other)][std::max(i, other)];
    Floats& y = e.m[std::min(j, other)][std::max(j, other)];
    const auto rotate = [&](Floats& a, Floats& b) {
        Floats new_a;
        Floats new_b;
        for_lanes<8>([&](std::size_t k) {
            new_a[k] = c[k] * a[k] - s[k] * b[k];
            new_b[k] = s[k] * a[k] + c[k] * b[k];
        });
        a = new_a;
        b = new_b;
    };
    rotate(x, y);
    for (std::size_t row = 0; row < 3; ++row) rotate(e.v[i][row], e.v[j][row]);
}

/// Makes two vectors unit and normal to each other, rounds them to float, and adds the third axis.
Axes rounded(Vector first, Vector second) {
    const double length = 1 / std::sqrt(dot(first, first));
    for (double& x : first) x *= length;
    const double along = dot(first, second);
    for (std::size_t i = 0; i < 3; ++i) second[i] -= along * first[i];
    const double other_length = 1 / std::sqrt(dot(second, second));
    for (double& x : second) x *= other_length;
    Axes axes{};
    for (std::size_t i = 0; i < 3; ++i) {
        axes.stored[0][i] = static_cast<float>(first[i]);
        axes.stored[1][i] = static_cast<float>(second[i]);
        axes.used[0][i] = double{axes.stored[0][i]};
        axes.used[1][i] = double{axes.stored[1][i]};
    }
    axes.used[2] = cross(axes.used[0], axes.used[1]);
    return axes;
}

/// Diagonalises the matrices divided by their traces. A matrix without a positive trace gets x, y,
/// z.
Eigen diagonal_of(const MomentLanes& moments) {
    constexpr int kSweeps = 3;  // the error of one is squared by the next
    Eigen e{};
    Doubles scale;
    for_lanes<8>([&](std::size_t k) {
        const double trace = (moments.second[0][k] + moments.second[1][k]) + moments.second[2][k];
        scale[k] = trace > 0 ? 1 / trace : 0;
    });
    for (std::size_t m = 0; m < 6; ++m) {
        Floats& to = e.m[std::min(kRow[m], kColumn[m])][std::max(kRow[m], kColumn[m])];
        for_lanes<8>(
            [&](std::size_t k) { to[k] = static_cast<float>(moments.second[m][k] * scale[k]); });
    }
    for (std::size_t i = 0; i < 3; ++i) e.v[i][i].fill(1);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        turn(e, 0, 1);
        turn(e, 0, 2);
        turn(e, 1, 2);
    }
    return e;
}

}  // namespace

Moments sum_of(const MomentLanes& lanes) {
    Moments sum;
    sum.area = sum_of(lanes.area);
    if (!(sum.area > 0)) return sum;
    std::array<Doubles, 3> away;
    for (std::size_t i = 0; i < 3; ++i) {
        Doubles weighed;
        for_lanes<8>([&](std::size_t k) { weighed[k] = lanes.area[k] * lanes.middle[i][k]; });
        sum.middle[i] = sum_of(weighed) / sum.area;
        for_lanes<8>([&](std::size_t k) { away[i][k] = lanes.middle[i][k] - sum.middle[i]; });
    }
    for (std::size_t m = 0; m < 6; ++m) {
        const Doubles& row = away[kRow[m]];
        const Doubles& column = away[kColumn[m]];
        Doubles second;
        for_lanes<8>([&](std::size_t k) {
            second[k] = lanes.second[m][k] + lanes.area[k] * row[k] * column[k];
        });
        sum.second[m] = sum_of(second);
    }
    return sum;
}

NodeAxes axes_of(const MomentLanes& moments) {
    const Eigen e = diagonal_of(moments);
    NodeAxes result;
    for (std::size_t k = 0; k < kBvhWidth; ++k) {
        const std::array<float, 3> value = {e.m[0][0][k], e.m[1][1][k], e.m[2][2][k]};
        std::size_t first = value[1] < value[0] ? 1 : 0;
        if (value[2] < value[first]) first = 2;
        std::size_t last = value[1] >= value[0] ? 1 : 0;
        if (value[2] >= value[last]) last = 2;
        if (first == last) last = (first + 1) % 3;
        const std::size_t second = 3 - first - last;
        const auto vector = [&](std::size_t i) {
            return Vector{double{e.v[i][0][k]}, double{e.v[i][1][k]}, double{e.v[i][2][k]}};
        };
        result[k] = rounded(vector(first), vector(second));
    }
    return result;
}

void write_box(const Vector& origin, const Axes& axes, const Reach& reach, double slack,
               format::OrientedNode& node, std::size_t box) {
    assert(slack >= 0 && box < kBvhWidth);
    std::array<double, 3> half{};
    double largest = 0;
    Vector centre = origin;
    for (std::size_t k = 0; k < 3; ++k) {
        half[k] = 0.5 * (reach.upper[k] - reach.lower[k]);
        largest = std::max(largest, half[k]);
        const double middle = 0.5 * (reach.upper[k] + reach.lower[k]);
        for (std::size_t i = 0; i < 3; ++i) centre[i] += middle * axes.used[k][i];
    }
    double moved = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto rounded_centre = static_cast<float>(centre[i]);
        moved += std::fabs(double{rounded_centre} - centre[i]);
        node.centre[i][box] = rounded_centre;
        for (std::size_t k = 0; k < 2; ++k) node.axis[k][i][box] = axes.stored[k][i];
    }
    for (std::size_t k = 0; k < 3; ++k) {
        node.half[k][box] =
            static_cast<float>((half[k] + moved + slack + largest * 0x1p-17) * (1 + 0x1p-22));
    }
}

void write_no_box(format::OrientedNode& node, std::size_t box) {
    for (std::size_t i = 0; i < 3; ++i) {
        node.axis[0][i][box] = i == 0 ? 1.0F : 0.0F;
        node.axis[1][i][box] = i == 1 ? 1.0F : 0.0F;
        node.centre[i][box] = 0;
        node.half[i][box] = -1;
    }
}

}  // namespace cdprep::build
