// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "exact/triangle_contact.h"

namespace cdprep::test {

// The contact of two triangles, from the definition and for any exact number type:
// std::int64_t for small integers, ExactNumber for doubles.
//
// Two convex sets have a common point exactly when their Minkowski difference contains the
// origin. For triangles this difference is the hull of the nine differences of corners. By
// Caratheodory's theorem the origin lies in it exactly when it lies in the simplex of at most
// four of them. This code uses neither planes nor edges, so it can share no mistake with the
// library's two tests.

template <class Number>
using ExactPoint = std::array<Number, 3>;
template <class Number>
using ExactTriangle = std::array<ExactPoint<Number>, 3>;

template <class Number>
ExactTriangle<Number> exact(const Corners& corners) {
    ExactTriangle<Number> result;
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = {Number(corners[i].x), Number(corners[i].y), Number(corners[i].z)};
    }
    return result;
}

template <class Number>
int sign_of(const Number& number) {
    return number > Number(0) ? 1 : (number < Number(0) ? -1 : 0);
}

template <class Number>
ExactPoint<Number> minus(const ExactPoint<Number>& a, const ExactPoint<Number>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Number>
ExactPoint<Number> cross(const ExactPoint<Number>& a, const ExactPoint<Number>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
Number dot(const ExactPoint<Number>& a, const ExactPoint<Number>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Number>
bool is_zero(const ExactPoint<Number>& a) {
    return std::all_of(a.begin(), a.end(), [](const Number& x) { return sign_of(x) == 0; });
}

template <class Number>
bool has_area(const ExactTriangle<Number>& t) {
    return !is_zero(cross(minus(t[1], t[0]), minus(t[2], t[0])));
}

/// Returns true if the signs are not all zero and no two are opposite. They are then the signs
/// of the weights of a point within a simplex.
template <std::size_t N>
bool agree(const std::array<int, N>& signs) {
    const auto [least, most] = std::minmax_element(signs.begin(), signs.end());
    return *least * *most >= 0 && (*least != 0 || *most != 0);
}

/// The position of the origin relative to the hull of nine points.
enum class Origin : std::uint8_t { outside, boundary, inside };

/// Returns the position for points that all lie on a line through the origin.
template <class Number>
Origin origin_on_line(const std::array<ExactPoint<Number>, 9>& points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<int, 9> signs;
        for (std::size_t i = 0; i < 9; ++i) signs[i] = sign_of(points[i][axis]);
        const auto [least, most] = std::minmax_element(signs.begin(), signs.end());
        if (*least < 0 && *most > 0) return Origin::inside;
        if (*least == 0 && *most == 0) continue;
        // A point that is zero on this axis is zero on all: all lie on one line.
        return *least * *most == 0 ? Origin::boundary : Origin::outside;
    }
    return Origin::inside;
}

/// Returns the position for points that span a plane through the origin, projected along `axis`.
template <class Number>
Origin origin_in_plane(const std::array<ExactPoint<Number>, 9>& points, std::size_t axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    std::array<std::array<int, 9>, 9> turn;
    for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t j = 0; j < 9; ++j) {
            turn[i][j] = sign_of(points[i][u] * points[j][v] - points[i][v] * points[j][u]);
        }
    }
    bool within = false;
    bool supported = false;  // a line through the origin has all points on one side
    for (std::size_t i = 0; i < 9; ++i) {
        const auto [least, most] = std::minmax_element(turn[i].begin(), turn[i].end());
        supported = supported || (*least < 0) != (*most > 0);
        for (std::size_t j = 0; j < i; ++j) {
            for (std::size_t k = 0; k < j; ++k) {
                within = within || agree(std::array<int, 3>{turn[j][k], -turn[i][k], turn[i][j]});
            }
        }
    }
    if (!within) return Origin::outside;
    return supported ? Origin::boundary : Origin::inside;
}

/// Returns the position for points that span space.
inline Origin origin_in_space(const std::array<std::array<std::array<int, 9>, 9>, 9>& volume) {
    bool within = false;
    bool supported = false;
    for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const auto [least, most] =
                std::minmax_element(volume[i][j].begin(), volume[i][j].end());
            supported = supported || (*least < 0) != (*most > 0);
            for (std::size_t k = 0; k < j && !within; ++k) {
                for (std::size_t l = 0; l < k && !within; ++l) {
                    within = agree(std::array<int, 4>{volume[j][k][l], -volume[i][k][l],
                                                      volume[i][j][l], -volume[i][j][k]});
                }
            }
        }
    }
    if (!within) return Origin::outside;
    return supported ? Origin::boundary : Origin::inside;
}

template <class Number>
TriangleContact contact_by_definition(const ExactTriangle<Number>& a,
                                      const ExactTriangle<Number>& b) {
    std::array<ExactPoint<Number>, 9> points;
    for (std::size_t i = 0; i < 9; ++i) points[i] = minus(a[i / 3], b[i % 3]);

    std::array<std::array<std::array<int, 9>, 9>, 9> volume{};
    ExactPoint<Number> normal{Number(0), Number(0), Number(0)};  // of the span, if a plane
    bool spans_space = false;
    for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const ExactPoint<Number> product = cross(points[i], points[j]);
            if (!is_zero(product)) normal = product;
            for (std::size_t k = 0; k < j; ++k) {
                const int s = sign_of(dot(product, points[k]));
                volume[i][j][k] = volume[j][k][i] = volume[k][i][j] = s;
                volume[j][i][k] = volume[i][k][j] = volume[k][j][i] = -s;
                spans_space = spans_space || s != 0;
            }
        }
    }
    const bool both_have_area = has_area(a) && has_area(b);
    Origin origin = Origin::outside;
    TriangleContact deepest = TriangleContact::touch;
    if (spans_space) {
        origin = origin_in_space(volume);
        if (both_have_area) deepest = TriangleContact::cross;
    } else if (!is_zero(normal)) {
        const auto axis =
            static_cast<std::size_t>(std::find_if(normal.begin(), normal.end(),
                                                  [](const Number& x) { return sign_of(x) != 0; }) -
                                     normal.begin());
        origin = origin_in_plane(points, axis);
        if (both_have_area) deepest = TriangleContact::coplanar_overlap;
    } else {
        origin = origin_on_line(points);
    }
    if (origin == Origin::outside) return TriangleContact::disjoint;
    return origin == Origin::inside ? deepest : TriangleContact::touch;
}

}  // namespace cdprep::test
