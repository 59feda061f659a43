// SPDX-License-Identifier: MIT
#include "support/exact_box.h"

#include <array>
#include <vector>

#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

using Point = std::array<ExactRational, 3>;

/// What of a polygon has side * coordinate >= side * limit (Sutherland and Hodgman 1974);
/// a segment or a point is a polygon too.
std::vector<Point> cut(const std::vector<Point>& polygon, std::size_t axis, double limit,
                       int side) {
    std::vector<Point> left;
    const auto height = [&](const Point& p) {
        const ExactRational above = p[axis] - ExactRational(limit);
        return side > 0 ? above : ExactRational(0.0) - above;
    };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& from = polygon[i];
        const Point& to = polygon[(i + 1) % polygon.size()];
        const ExactRational at_from = height(from);
        const ExactRational at_to = height(to);
        if (at_from.sign() >= 0) left.push_back(from);
        if (at_from.sign() * at_to.sign() >= 0) continue;
        const ExactRational s = at_from / (at_from - at_to);
        Point between;
        for (std::size_t k = 0; k < 3; ++k) between[k] = from[k] + s * (to[k] - from[k]);
        left.push_back(between);
    }
    return left;
}

}  // namespace

bool touches_box_by_cutting(const Corners& t, const Box3& box) {
    std::vector<Point> polygon;
    for (const Double3& p : t) polygon.push_back({p.x, p.y, p.z});
    const std::array<double, 3> lower = {box.lower.x, box.lower.y, box.lower.z};
    const std::array<double, 3> upper = {box.upper.x, box.upper.y, box.upper.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        polygon = cut(cut(polygon, axis, lower[axis], 1), axis, upper[axis], -1);
    }
    return !polygon.empty();
}

}  // namespace cdprep::test
