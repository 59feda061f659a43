// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cdprep/contacts.h"
#include "exact/vectors.h"

namespace cdprep {

/// Returns a number for two others, in this order. Equal ones are rare (Steele, Lea and Flood
/// 2014).
[[nodiscard]] inline std::uint64_t mixed_ids(std::uint64_t x, std::uint64_t y) noexcept {
    std::uint64_t z = x * 0x9e3779b97f4a7c15U + y;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
    z = (z ^ z >> 27) * 0x94d049bb133111ebU;
    return z ^ z >> 31;
}

/// The lengths between which squares and areas stay in the range of double.
inline constexpr double kLeastSize = 0x1p-480, kMostSize = 0x1p480;

/// Returns the points of a contact without a manifold as one of a manifold.
[[nodiscard]] inline ManifoldPoint only_point(const Contact& contact) noexcept {
    return {contact.point_a, contact.point_b,
            dot(contact.normal, contact.point_b - contact.point_a), 0};
}

/// Sets the points of a contact to at most four of `points`, of which there is at least one. The
/// first is the deepest (of several, the outermost), the second the one farthest from it. The
/// others have the largest triangles on either side of the line between. Of equal points it takes
/// the first. `points` are not those of the contact.
inline void choose_four(std::span<const ManifoldPoint> points, Contact& contact) noexcept {
    const auto best = [&](auto&& score) {
        std::size_t top = 0;
        for (std::size_t i = 1; i < points.size(); ++i) {
            if (score(points[i]) > score(points[top])) top = i;
        }
        return top;
    };
    contact.point_count = 0;
    const auto take = [&](std::size_t i) { contact.points[contact.point_count++] = points[i]; };
    // Points that lie in a plane are equally deep up to rounding: then the outermost is first.
    constexpr double kLevel = 1e-6;  // of their extent
    // Of the squared line: twice the area of a triangle of rounding, with a thousandfold margin.
    constexpr double kNoArea = 1e-12;
    Double3 middle{};
    for (const ManifoldPoint& p : points) middle = middle + p.on_a;
    middle = (1 / static_cast<double>(points.size())) * middle;
    double scale = 1;
    const auto scaled = [&](const Double3& d) { return scale * d; };
    const auto squared_way = [&](const ManifoldPoint& p) {
        const Double3 d = scaled(p.on_a - middle);
        return dot(d, d);
    };
    double widest = squared_way(points[best(squared_way)]);
    if (!(widest > kLeastSize * kLeastSize && widest < kMostSize * kMostSize)) {
        const auto size = [&](const ManifoldPoint& p) { return largest_of(p.on_a - middle); };
        const double most = size(points[best(size)]);
        if (most >= std::numeric_limits<double>::min()) scale = 1 / most;
        widest = squared_way(points[best(squared_way)]);
    }
    const double deepest =
        points[best([](const ManifoldPoint& p) { return -p.distance; })].distance;
    const double level = deepest + kLevel * (std::sqrt(widest) / scale);
    const std::size_t first =
        best([&](const ManifoldPoint& p) { return p.distance <= level ? squared_way(p) : -1.0; });
    take(first);
    const Double3 origin = points[first].on_a;
    const std::size_t second = best([&](const ManifoldPoint& p) {
        const Double3 d = scaled(p.on_a - origin);
        return dot(d, d);
    });
    const Double3 line = scaled(points[second].on_a - origin);
    if (!(dot(line, line) > 0)) return;
    take(second);
    for (const double side : {1.0, -1.0}) {
        const auto area = [&](const ManifoldPoint& p) {
            return side * dot(contact.normal, cross(line, scaled(p.on_a - origin)));
        };
        const std::size_t third = best(area);
        // A smaller area is rounding: no point is beside the line.
        if (area(points[third]) > kNoArea * dot(line, line)) take(third);
    }
}

}  // namespace cdprep
