// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "exact/box3.h"

// Tests the same 13 directions as triangle_box.cpp in double, and answers where rounding cannot
// change the answer.
//
// Let u = 2^-53. Corners v and the box are relative to the box's lower corner. Each coordinate,
// side of the box and edge is one difference of doubles, off by a factor of 1 + u. M is the
// largest magnitude per axis of these coordinates and sides.
//
// Along axis x an edge e gives the direction (0, -ez, ey). Let B = |ey| Mz + |ez| My. A corner's
// height along it, ey vz - ez vy, is off by (3u + u) B. The box's height has the same error: it is
// a sum of two products or their zeros. Their difference, at most 2 B in magnitude, rounds by 2u B
// more. 16u B covers all of it, and the roundings of B.
//
// Along the triangle's normal, n = e0 x e1 is off by 4u N per component. N is the sum of the
// magnitudes of its two products. A product n v is off by 6u N M, and the sum of three by 2u more.
// The box's is off by as much. Their difference adds 2u. 32u times the sum of N M covers it.
//
// Where B is above 1e-290, the loss by products that underflow is negligible against u B. The two
// products of a component of n may lose 2^-1074 together, and a large M of that axis magnifies it.
// A triangle's or box's height loses 2^-1074 times the sum of M, and 2^-1070 covers both.
// Comparisons with overflowed numbers are false, which leaves the case to the exact test. An edge
// along an axis gives no direction with it. That is exact: differences of unequal numbers are
// never 0.

namespace cdprep {

/// The answer whether a triangle and a box have a common point, as far as double can decide.
enum class TouchesBox : std::uint8_t { no, yes, unknown };

/// The filter for a triangle and a box that is not empty.
class TriangleBoxFilter {
public:
    TriangleBoxFilter(const Corners& t, const Box3& box) noexcept {
        const Double3& from = box.lower;
        for (std::size_t i = 0; i < 3; ++i) {
            const Double3& next = t[(i + 1) % 3];
            corner_[i] = {t[i].x - from.x, t[i].y - from.y, t[i].z - from.z};
            edge_[i] = {next.x - t[i].x, next.y - t[i].y, next.z - t[i].z};
        }
        side_ = {box.upper.x - from.x, box.upper.y - from.y, box.upper.z - from.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            most_[axis] = std::max({side_[axis], std::fabs(corner_[0][axis]),
                                    std::fabs(corner_[1][axis]), std::fabs(corner_[2][axis])});
        }
    }

    /// Requires that their boxes overlap.
    [[nodiscard]] TouchesBox touches() const noexcept {
        TouchesBox found = TouchesBox::yes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t edge = 0; edge < 3; ++edge) {
                const TouchesBox seen = along(axis, edge);
                if (seen == TouchesBox::no) return seen;
                if (seen == TouchesBox::unknown) found = seen;
            }
        }
        const TouchesBox seen = across();
        return seen == TouchesBox::yes ? found : seen;
    }

private:
    using Vector = std::array<double, 3>;

    static constexpr double kAlong = 0x1p-49;   ///< 16u
    static constexpr double kAcross = 0x1p-48;  ///< 32u
    static constexpr double kLost = 0x1p-1070;  ///< by products that underflow
    static constexpr double kLeast = 1e-290;

    struct Reach {
        double lower;
        double upper;
    };

    static TouchesBox compare(const Reach& triangle, const Reach& box, double slack) noexcept {
        const double above = triangle.lower - box.upper;
        const double below = box.lower - triangle.upper;
        if (above > slack || below > slack) return TouchesBox::no;
        return above < -slack && below < -slack ? TouchesBox::yes : TouchesBox::unknown;
    }

    /// Tests the direction normal to an axis and an edge.
    [[nodiscard]] TouchesBox along(std::size_t axis, std::size_t edge) const noexcept {
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        const double eu = edge_[edge][u];
        const double ev = edge_[edge][v];
        if (eu == 0 && ev == 0) return TouchesBox::yes;
        const Vector& on = corner_[edge];
        const Vector& off = corner_[(edge + 2) % 3];
        const double first = eu * on[v] - ev * on[u];
        const double second = eu * off[v] - ev * off[u];
        const double by_u = -ev * side_[u];
        const double by_v = eu * side_[v];
        const double size = std::fabs(eu) * most_[v] + std::fabs(ev) * most_[u];
        if (!(size > kLeast)) return TouchesBox::unknown;
        return compare(
            {std::min(first, second), std::max(first, second)},
            {std::min(by_u, 0.0) + std::min(by_v, 0.0), std::max(by_u, 0.0) + std::max(by_v, 0.0)},
            kAlong * size);
    }

    /// Tests the direction of the triangle's normal.
    [[nodiscard]] TouchesBox across() const noexcept {
        double height = 0;
        Reach box{0, 0};
        double size = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t u = (axis + 1) % 3;
            const std::size_t v = (axis + 2) % 3;
            const double left = edge_[0][u] * edge_[1][v];
            const double right = edge_[0][v] * edge_[1][u];
            const double normal = left - right;
            height += normal * corner_[0][axis];
            box.lower += std::min(normal * side_[axis], 0.0);
            box.upper += std::max(normal * side_[axis], 0.0);
            size += (std::fabs(left) + std::fabs(right)) * most_[axis];
        }
        if (!(size > kLeast)) return TouchesBox::unknown;
        const double lost = kLost * (most_[0] + most_[1] + most_[2]);
        return compare({height, height}, box, kAcross * size + lost);
    }

    std::array<Vector, 3> corner_;  ///< relative to the box's lower corner
    std::array<Vector, 3> edge_;    ///< from corner i to the next
    Vector side_;                   ///< of the box
    Vector most_;                   ///< largest magnitude per axis of coordinates and sides
};

}  // namespace cdprep
