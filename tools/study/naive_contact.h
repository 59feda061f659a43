// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cdprep/format/geometry.h"

namespace cdprep::study {

/// A triangle-triangle test as code without exact arithmetic does it, in a given number type. It
/// tests six edges against triangles by the signs of volumes. Volumes of at most `tolerance`,
/// relative to the cube of the largest difference of coordinates, count as 0, and 0 counts as
/// touching. Triangles in one plane count as apart, as is common. This test only shows the cost and
/// the errors of such code; do not use its answers.
template <class Number>
class NaiveContact {
public:
    using Point = std::array<Number, 3>;
    using Corners = std::array<Point, 3>;

    explicit NaiveContact(Number tolerance) : tolerance_(tolerance) {}

    /// Returns the corners rounded to the type.
    [[nodiscard]] static Corners rounded(const std::array<format::Double3, 3>& corners) {
        Corners result;
        for (std::size_t i = 0; i < 3; ++i) {
            result[i] = {static_cast<Number>(corners[i].x), static_cast<Number>(corners[i].y),
                         static_cast<Number>(corners[i].z)};
        }
        return result;
    }

    [[nodiscard]] bool touch(const Corners& a, const Corners& b) const {
        return any_edge_pierces(a, b) || any_edge_pierces(b, a);
    }

private:
    /// Returns the side of the plane of a, b, c on which d lies: -1, 0 or 1.
    [[nodiscard]] int side(const Point& a, const Point& b, const Point& c, const Point& d) const {
        Point u{};
        Point v{};
        Point w{};
        Number most = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            u[i] = a[i] - d[i];
            v[i] = b[i] - d[i];
            w[i] = c[i] - d[i];
            most = std::max({most, std::abs(u[i]), std::abs(v[i]), std::abs(w[i])});
        }
        const Number volume = u[0] * (v[1] * w[2] - v[2] * w[1]) +
                              u[1] * (v[2] * w[0] - v[0] * w[2]) +
                              u[2] * (v[0] * w[1] - v[1] * w[0]);
        const Number zero = tolerance_ * most * most * most;
        return volume > zero ? 1 : (volume < -zero ? -1 : 0);
    }

    [[nodiscard]] bool pierces(const Point& p, const Point& q, const Corners& t) const {
        const int from = side(t[0], t[1], t[2], p);
        const int to = side(t[0], t[1], t[2], q);
        if (from * to > 0 || (from == 0 && to == 0)) return false;
        const int first = side(p, q, t[0], t[1]);
        const int second = side(p, q, t[1], t[2]);
        const int third = side(p, q, t[2], t[0]);
        return (first >= 0 && second >= 0 && third >= 0) ||
               (first <= 0 && second <= 0 && third <= 0);
    }

    [[nodiscard]] bool any_edge_pierces(const Corners& edges, const Corners& t) const {
        return pierces(edges[0], edges[1], t) || pierces(edges[1], edges[2], t) ||
               pierces(edges[2], edges[0], t);
    }

    Number tolerance_;
};

}  // namespace cdprep::study
