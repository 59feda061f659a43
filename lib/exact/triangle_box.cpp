// SPDX-License-Identifier: MIT
#include "exact/triangle_box.h"

#include "exact/predicates.h"
#include "exact/triangle_box_filter.h"

// A box and a triangle are disjoint exactly if one of 13 directions separates them. These are the
// normals of the box's faces and of the triangle, and the products of an edge of each. See
// Gottschalk, Lin and Manocha 1996, and Akenine-Moller 2001. The products with the box's edges
// along one axis are normal to that axis. They and the box's faces separate exactly if the views
// along the axis are disjoint. These views are a rectangle and a triangle in a plane. There, and
// for the triangle's plane, one corner of the box is enough: the extreme one in the direction.
// Signs alone determine which corner that is.

namespace cdprep {
namespace {

/// Returns the coordinate along axis 0, 1 or 2.
double coordinate(const Double3& p, std::size_t axis) noexcept {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// The box and the triangle, seen along an axis.
struct Seen {
    std::array<Double2, 3> corner;
    Double2 lower;
    Double2 upper;
};

Seen seen_along(std::size_t axis, const Corners& t, const Box3& box) noexcept {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const auto flat = [&](const Double3& p) { return Double2{coordinate(p, u), coordinate(p, v)}; };
    return {{flat(t[0]), flat(t[1]), flat(t[2])}, flat(box.lower), flat(box.upper)};
}

/// Returns whether the whole rectangle lies to the right of the line, or to its left for side -1.
/// Tests only the corner that is farthest to the other side.
bool is_beyond(const Double2& from, const Double2& to, const Seen& view, int side) noexcept {
    const bool up = side > 0 ? to.x >= from.x : to.x < from.x;
    const bool back = side > 0 ? to.y >= from.y : to.y < from.y;
    const Double2 corner = {back ? view.lower.x : view.upper.x, up ? view.upper.y : view.lower.y};
    return orient2d(from, to, corner) == -side;
}

/// Returns whether a line through an edge separates the two in this view. `turn` is the orientation
/// of the triangle's corners in the view.
bool is_separated(const Seen& view, int turn) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
        const Double2& from = view.corner[i];
        const Double2& to = view.corner[(i + 1) % 3];
        if (turn >= 0 && is_beyond(from, to, view, 1)) return true;
        if (turn <= 0 && is_beyond(from, to, view, -1)) return true;
    }
    return false;
}

/// Returns the box's corner that is farthest along a direction with these signs.
Double3 farthest(const Box3& box, const std::array<int, 3>& direction) noexcept {
    return {direction[0] > 0 ? box.upper.x : box.lower.x,
            direction[1] > 0 ? box.upper.y : box.lower.y,
            direction[2] > 0 ? box.upper.z : box.lower.z};
}

bool is_on_one_side(const Corners& t, const std::array<int, 3>& normal, const Box3& box) noexcept {
    // orient3d() is positive behind the plane; the normal points in front.
    if (orient3d(t[0], t[1], t[2], farthest(box, normal)) > 0) return true;
    const std::array<int, 3> back = {-normal[0], -normal[1], -normal[2]};
    return orient3d(t[0], t[1], t[2], farthest(box, back)) < 0;
}

}  // namespace

bool triangle_touches_box(const Corners& t, const Box3& box) noexcept {
    const auto& [a, b, c] = t;
    if (!overlap(box_around(t), box) || !overlap(box, box)) return false;
    if (holds(box, a) || holds(box, b) || holds(box, c)) return true;
    const TouchesBox filtered = TriangleBoxFilter(t, box).touches();
    if (filtered != TouchesBox::unknown) return filtered == TouchesBox::yes;
    std::array<int, 3> normal{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Seen view = seen_along(axis, t, box);
        normal[axis] = orient2d(view.corner[0], view.corner[1], view.corner[2]);
        if (is_separated(view, normal[axis])) return false;
    }
    return !is_on_one_side(t, normal, box);
}

}  // namespace cdprep
