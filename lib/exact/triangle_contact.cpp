// SPDX-License-Identifier: MIT
#include "exact/triangle_contact.h"

#include <algorithm>
#include <cassert>

#include "exact/integer_points.h"
#include "exact/predicates.h"

namespace cdprep {
namespace {

// The same code serves doubles and integers. Point is Double3, with predicates that are always
// exact, or Integer3.

using Signs = std::array<int, 3>;

template <class Point>
using Triangle = std::array<Point, 3>;

/// The coordinate plane to which a planar figure is projected.
enum class View : std::uint8_t { yz, zx, xy };

Double2 flat(const Double3& /*kind*/, double u, double v) {
    return {u, v};
}
Integer2 flat(const Integer3& /*kind*/, std::int64_t u, std::int64_t v) {
    return {u, v};
}

template <class Point>
auto seen(View view, const Point& p) {
    switch (view) {
        case View::yz:
            return flat(p, p.y, p.z);
        case View::zx:
            return flat(p, p.z, p.x);
        default:
            return flat(p, p.x, p.y);
    }
}

template <class Point>
int orient_seen(View view, const Point& a, const Point& b, const Point& c) {
    return orient2d(seen(view, a), seen(view, b), seen(view, c));
}

bool all_zero(const Signs& s) {
    return s[0] == 0 && s[1] == 0 && s[2] == 0;
}

bool strictly_one_side(const Signs& s) {
    return s[0] != 0 && s[0] == s[1] && s[0] == s[2];
}

bool on_both_sides(const Signs& s) {
    return std::min({s[0], s[1], s[2]}) < 0 && std::max({s[0], s[1], s[2]}) > 0;
}

// --- Crossing planes: Guigue and Devillers 2003 -----------------------------

/// The corner that is alone on its side of the other plane, and that side.
struct Lone {
    std::size_t corner;
    int side;
};

/// Requires signs that are not all equal. A zero counts for the side that leaves one corner alone.
Lone find_lone(const Signs& s) {
    assert(s[0] != s[1] || s[1] != s[2]);
    const auto where = [&s](int sign) {
        return static_cast<std::size_t>(std::find(s.begin(), s.end(), sign) - s.begin());
    };
    const auto plus = std::count(s.begin(), s.end(), 1);
    const auto minus = std::count(s.begin(), s.end(), -1);
    if (plus == 1) return {where(1), 1};
    if (minus == 1) return {where(-1), -1};
    return plus == 2 ? Lone{where(0), -1} : Lone{where(0), 1};
}

/// Both triangles, rotated so that each starts with its lone corner. They are wound so that the
/// other's lone corner is on the positive side.
template <class Point>
struct Canonical {
    Triangle<Point> a;
    Triangle<Point> b;
};

template <class Point>
Canonical<Point> canonical(const Triangle<Point>& a, const Signs& a_signs, const Triangle<Point>& b,
                           const Signs& b_signs) {
    const Lone lone_a = find_lone(a_signs);
    const Lone lone_b = find_lone(b_signs);
    Canonical<Point> turned{};
    for (std::size_t i = 0; i < 3; ++i) {
        turned.a[i] = a[(lone_a.corner + i) % 3];
        turned.b[i] = b[(lone_b.corner + i) % 3];
    }
    if (lone_a.side < 0) std::swap(turned.b[1], turned.b[2]);
    if (lone_b.side < 0) std::swap(turned.a[1], turned.a[2]);
    return turned;
}

/// Returns the greater of two signs: 1 apart, 0 touching, -1 sharing more than a point. They
/// compare the ends of the intervals in which the triangles meet the common line. The caller treats
/// all values above `limit` alike.
template <class Point>
int interval_order(const Canonical<Point>& t, int limit) {
    const int first = orient3d(t.a[0], t.a[1], t.b[0], t.b[1]);
    if (first > limit) return first;
    return std::max(first, orient3d(t.a[0], t.a[2], t.b[2], t.b[0]));
}

// --- One plane ---------------------------------------------------------------

/// Returns a view in which the triangle keeps its area. Requires a triangle with area.
template <class Point>
View view_of(const Triangle<Point>& t) {
    for (const View view : {View::yz, View::zx}) {
        if (orient_seen(view, t[0], t[1], t[2]) != 0) return view;
    }
    return View::xy;
}

/// Returns whether the line through an edge of `a` has all of `b` beyond it. With `limit` 0, points
/// on the line count as beyond it too.
template <class Point>
bool edge_separates(View view, const Triangle<Point>& a, const Triangle<Point>& b, int limit) {
    const int turn = orient_seen(view, a[0], a[1], a[2]);
    assert(turn != 0);
    for (std::size_t i = 0; i < 3; ++i) {
        const Point& from = a[i];
        const Point& to = a[(i + 1) % 3];
        const bool beyond = std::all_of(b.begin(), b.end(), [&](const Point& p) {
            return turn * orient_seen(view, from, to, p) <= limit;
        });
        if (beyond) return true;
    }
    return false;
}

/// Two triangles with area in one plane are disjoint exactly if an edge of one separates them
/// strictly. They share no area exactly if an edge separates them weakly.
template <class Point>
TriangleContact coplanar_contact(const Triangle<Point>& a, const Triangle<Point>& b) {
    const View view = view_of(a);
    if (edge_separates(view, a, b, -1) || edge_separates(view, b, a, -1)) {
        return TriangleContact::disjoint;
    }
    if (edge_separates(view, a, b, 0) || edge_separates(view, b, a, 0)) {
        return TriangleContact::touch;
    }
    return TriangleContact::coplanar_overlap;
}

// --- Segments ------------------------------------------------------------------

/// A segment; with equal ends, a point.
template <class Point>
struct Segment {
    Point from;
    Point to;
};

template <class Point>
bool precedes(const Point& a, const Point& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

/// Returns the segment that three collinear corners span. Along a line, the order of coordinates is
/// the order on the line.
template <class Point>
Segment<Point> span_of(const Triangle<Point>& t) {
    const auto [least, greatest] = std::minmax_element(t.begin(), t.end(), precedes<Point>);
    return {*least, *greatest};
}

template <class Coordinate>
bool within(Coordinate x, Coordinate a, Coordinate b) {
    return std::min(a, b) <= x && x <= std::max(a, b);
}

/// Returns whether p, known to be collinear with the segment, lies on it.
template <class Point>
bool between(const Point& p, const Segment<Point>& s) {
    return within(p.x, s.from.x, s.to.x) && within(p.y, s.from.y, s.to.y) &&
           within(p.z, s.from.z, s.to.z);
}

template <class Point>
bool collinear(const Point& a, const Point& b, const Point& c) {
    return orient_seen(View::yz, a, b, c) == 0 && orient_seen(View::zx, a, b, c) == 0 &&
           orient_seen(View::xy, a, b, c) == 0;
}

/// Tests two segments in one plane, in a view that keeps its area.
template <class Point>
bool segments_touch_seen(View view, const Segment<Point>& s, const Segment<Point>& t) {
    const int s1 = orient_seen(view, s.from, s.to, t.from);
    const int s2 = orient_seen(view, s.from, s.to, t.to);
    const int t1 = orient_seen(view, t.from, t.to, s.from);
    const int t2 = orient_seen(view, t.from, t.to, s.to);
    if (s1 * s2 < 0 && t1 * t2 < 0) return true;
    return (s1 == 0 && between(t.from, s)) || (s2 == 0 && between(t.to, s)) ||
           (t1 == 0 && between(s.from, t)) || (t2 == 0 && between(s.to, t));
}

/// Tests a segment and a triangle with area, both in one plane.
template <class Point>
bool touches_in_plane(const Segment<Point>& s, const Triangle<Point>& t) {
    const View view = view_of(t);
    const int turn = orient_seen(view, t[0], t[1], t[2]);
    assert(turn != 0);
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Segment<Point> edge{t[i], t[(i + 1) % 3]};
        if (segments_touch_seen(view, s, edge)) return true;
        inside = inside && turn * orient_seen(view, edge.from, edge.to, s.from) > 0;
    }
    return inside;
}

/// Tests a segment and a triangle with area (signed volumes, Feito and Torres 1997). They touch
/// when the ends are not on one side of the plane, and the line through them passes the three edges
/// on one side.
template <class Point>
bool segment_touches(const Segment<Point>& s, const Triangle<Point>& t) {
    const int from = orient3d(t[0], t[1], t[2], s.from);
    const int to = orient3d(t[0], t[1], t[2], s.to);
    if (from * to > 0) return false;
    if (from == 0 && to == 0) return touches_in_plane(s, t);
    const int e0 = orient3d(s.from, s.to, t[0], t[1]);
    const int e1 = orient3d(s.from, s.to, t[1], t[2]);
    const int e2 = orient3d(s.from, s.to, t[2], t[0]);
    return !(std::min({e0, e1, e2}) < 0 && std::max({e0, e1, e2}) > 0);
}

/// Tests two segments anywhere in space.
template <class Point>
bool segments_touch(const Segment<Point>& s, const Segment<Point>& t) {
    if (orient3d(s.from, s.to, t.from, t.to) != 0) return false;
    const std::array<Point, 4> points = {s.from, s.to, t.from, t.to};
    for (const View view : {View::yz, View::zx, View::xy}) {
        for (std::size_t skipped = 0; skipped < 4; ++skipped) {
            const Point& a = points[(skipped + 1) % 4];
            const Point& b = points[(skipped + 2) % 4];
            const Point& c = points[(skipped + 3) % 4];
            if (orient_seen(view, a, b, c) != 0) return segments_touch_seen(view, s, t);
        }
    }
    return between(s.from, t) || between(s.to, t) || between(t.from, s);  // all on one line
}

/// Requires that at least one of the two has no area.
template <class Point>
bool degenerate_touch(const Triangle<Point>& a, bool a_is_flat, const Triangle<Point>& b,
                      bool b_is_flat) {
    assert(a_is_flat || b_is_flat);
    if (a_is_flat && b_is_flat) return segments_touch(span_of(a), span_of(b));
    return a_is_flat ? segment_touches(span_of(a), b) : segment_touches(span_of(b), a);
}

template <class Point>
bool is_flat(const Triangle<Point>& t) {
    return collinear(t[0], t[1], t[2]);
}

/// Answers where all corners of one have sign 0: the planes coincide, or a triangle without area
/// defines no plane.
template <class Point>
TriangleContact flat_contact(const Triangle<Point>& a, const Triangle<Point>& b) {
    const bool a_is_flat = is_flat(a);
    const bool b_is_flat = is_flat(b);
    if (!a_is_flat && !b_is_flat) return coplanar_contact(a, b);
    return degenerate_touch(a, a_is_flat, b, b_is_flat) ? TriangleContact::touch
                                                        : TriangleContact::disjoint;
}

template <class Point>
TriangleContact contact_of(const Triangle<Point>& a, const Triangle<Point>& b) {
    const Signs a_signs = plane_signs(b, a);
    if (strictly_one_side(a_signs)) return TriangleContact::disjoint;
    if (all_zero(a_signs)) return flat_contact(a, b);
    const Signs b_signs = plane_signs(a, b);
    if (strictly_one_side(b_signs)) return TriangleContact::disjoint;
    if (all_zero(b_signs)) return flat_contact(a, b);
    const int order = interval_order(canonical(a, a_signs, b, b_signs), 0);
    if (order > 0) return TriangleContact::disjoint;
    const bool crosses = order < 0 && on_both_sides(a_signs) && on_both_sides(b_signs);
    return crosses ? TriangleContact::cross : TriangleContact::touch;
}

// --- Stages ----------------------------------------------------------------------

/// Both triangles in machine integers, relative to a corner of the first.
struct IntegerPair {
    Triangle<Integer3> a;
    Triangle<Integer3> b;
};

std::optional<IntegerPair> in_integers(const Corners& a, const Corners& b) {
    constexpr int kBits = 61;  // so differences of two have 62
    const auto x = scaled_axis<5>({a[1].x, a[2].x, b[0].x, b[1].x, b[2].x}, a[0].x, kBits);
    const auto y = scaled_axis<5>({a[1].y, a[2].y, b[0].y, b[1].y, b[2].y}, a[0].y, kBits);
    const auto z = scaled_axis<5>({a[1].z, a[2].z, b[0].z, b[1].z, b[2].z}, a[0].z, kBits);
    if (!x.fits || !y.fits || !z.fits) return std::nullopt;
    const auto point = [&](std::size_t i) { return Integer3{x.at[i], y.at[i], z.at[i]}; };
    return IntegerPair{{Integer3{0, 0, 0}, point(0), point(1)}, {point(2), point(3), point(4)}};
}

constexpr int kUnknown = 2;

bool all_known(const Signs& s) {
    return std::none_of(s.begin(), s.end(), [](int sign) { return sign == kUnknown || sign == 0; });
}

}  // namespace

bool is_degenerate(const Corners& t) noexcept {
    return is_flat(t);
}

std::optional<TriangleContact> contact_by_filter(const Corners& a, const Corners& b) noexcept {
    const Signs a_signs = filtered_plane_signs(b, a);
    if (strictly_one_side(a_signs)) {
        // All undecided: the triangles may lie in one plane. Then b's signs are undecided too.
        if (a_signs[0] == kUnknown) return std::nullopt;
        return TriangleContact::disjoint;
    }
    const Signs b_signs = filtered_plane_signs(a, b);
    if (b_signs[0] != kUnknown && strictly_one_side(b_signs)) return TriangleContact::disjoint;
    if (!all_known(a_signs) || !all_known(b_signs)) return std::nullopt;
    const Canonical<Double3> t = canonical(a, a_signs, b, b_signs);
    const int first = filtered_orient3d(t.a[0], t.a[1], t.b[0], t.b[1]);
    if (first == 1) return TriangleContact::disjoint;
    const int second = filtered_orient3d(t.a[0], t.a[2], t.b[2], t.b[0]);
    if (second == 1) return TriangleContact::disjoint;
    if (first == -1 && second == -1) return TriangleContact::cross;
    return std::nullopt;
}

TriangleContact contact_beyond_filter(const Corners& a, const Corners& b) noexcept {
    if (const auto pair = in_integers(a, b)) return contact_of(pair->a, pair->b);
    return contact_of(a, b);
}

bool share_a_corner(const Corners& a, const Corners& b) noexcept {
    bool shared = false;
    for (const Double3& p : a) {
        for (const Double3& q : b) shared |= p == q;
    }
    return shared;
}

TriangleContact classify_contact(const Corners& a, const Corners& b) noexcept {
    const std::optional<TriangleContact> sure = contact_by_filter(a, b);
    return sure ? *sure : contact_beyond_filter(a, b);
}

// On the common line, the edges from a lone corner bound the part that belongs to its triangle.
// orient3d(a0, ai, b0, bk) is positive when the point on a0 ai lies beyond that on b0 bk. Here
// a0 a1 comes before a0 a2, and so b0 b2 before b0 b1.
std::optional<CrossingEnds> crossing_ends(const Corners& a, const Corners& b) noexcept {
    const Signs a_signs = plane_signs(b, a);
    const Signs b_signs = plane_signs(a, b);
    if (all_zero(a_signs) || all_zero(b_signs)) return std::nullopt;
    // Damaged boxes can produce a pair that is not in contact.
    if (strictly_one_side(a_signs) || strictly_one_side(b_signs)) return std::nullopt;
    const auto [s, t] = canonical(a, a_signs, b, b_signs);
    const bool first_of_a = orient3d(s[0], s[1], t[0], t[2]) > 0;
    const bool second_of_a = orient3d(s[0], s[2], t[0], t[1]) <= 0;
    const PiercingEdge first = first_of_a ? PiercingEdge{s[0], s[1], true}  //
                                          : PiercingEdge{t[0], t[2], false};
    const PiercingEdge second = second_of_a ? PiercingEdge{s[0], s[2], true}  //
                                            : PiercingEdge{t[0], t[1], false};
    if (first_of_a != second_of_a) {
        const int gap = first_of_a ? orient3d(s[0], s[1], t[0], t[1])  //
                                   : orient3d(s[0], s[2], t[0], t[2]);
        return CrossingEnds{first, second, gap == 0};
    }
    const bool lone_is_on_plane = first_of_a ? a_signs[find_lone(a_signs).corner] == 0
                                             : b_signs[find_lone(b_signs).corner] == 0;
    return CrossingEnds{first, second, lone_is_on_plane};
}

bool triangles_touch(const Corners& a, const Corners& b) noexcept {
    return classify_contact(a, b) != TriangleContact::disjoint;
}

bool triangles_touch_by_segments(const Corners& a, const Corners& b) noexcept {
    const bool a_is_flat = is_degenerate(a);
    const bool b_is_flat = is_degenerate(b);
    if (a_is_flat || b_is_flat) return degenerate_touch(a, a_is_flat, b, b_is_flat);
    for (std::size_t i = 0; i < 3; ++i) {
        if (segment_touches(Segment<Double3>{a[i], a[(i + 1) % 3]}, b)) return true;
        if (segment_touches(Segment<Double3>{b[i], b[(i + 1) % 3]}, a)) return true;
    }
    return false;
}

}  // namespace cdprep
