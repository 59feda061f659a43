// SPDX-License-Identifier: MIT
#include "triangle_contact.h"

#include <algorithm>

#include "predicates.h"

namespace cdprep {
namespace {

using Signs = std::array<int, 3>;

/// The coordinate plane that a planar figure is seen in.
enum class View : std::uint8_t { yz, zx, xy };

Double2 seen(View view, const Double3& p) {
    switch (view) {
        case View::yz:
            return {p.y, p.z};
        case View::zx:
            return {p.z, p.x};
        default:
            return {p.x, p.y};
    }
}

int orient_seen(View view, const Double3& a, const Double3& b, const Double3& c) {
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

/// Not for three equal signs. A zero counts to whichever side leaves one corner
/// alone.
Lone find_lone(const Signs& s) {
    const auto where = [&s](int sign) {
        return static_cast<std::size_t>(std::find(s.begin(), s.end(), sign) - s.begin());
    };
    const auto plus = std::count(s.begin(), s.end(), 1);
    const auto minus = std::count(s.begin(), s.end(), -1);
    if (plus == 1) return {where(1), 1};
    if (minus == 1) return {where(-1), -1};
    return plus == 2 ? Lone{where(0), -1} : Lone{where(0), 1};
}

/// Both triangles turned so that each starts with its lone corner, and wound so
/// that the other's lone corner is on the positive side.
struct Canonical {
    Corners a;
    Corners b;
};

Canonical canonical(const Corners& a, const Signs& a_signs, const Corners& b,
                    const Signs& b_signs) {
    const Lone lone_a = find_lone(a_signs);
    const Lone lone_b = find_lone(b_signs);
    Canonical turned{};
    for (std::size_t i = 0; i < 3; ++i) {
        turned.a[i] = a[(lone_a.corner + i) % 3];
        turned.b[i] = b[(lone_b.corner + i) % 3];
    }
    if (lone_a.side < 0) std::swap(turned.b[1], turned.b[2]);
    if (lone_b.side < 0) std::swap(turned.a[1], turned.a[2]);
    return turned;
}

/// Returns the greater of the two signs that compare the ends of the intervals
/// in which the triangles meet the common line: 1 apart, 0 touching, -1 sharing
/// more than a point. `limit` is the value beyond which the caller stops caring.
int interval_order(const Canonical& t, int limit) {
    const int first = orient3d(t.a[0], t.a[1], t.b[0], t.b[1]);
    if (first > limit) return first;
    return std::max(first, orient3d(t.a[0], t.a[2], t.b[2], t.b[0]));
}

// --- One plane ---------------------------------------------------------------

/// A view in which the triangle keeps its area; only for one that has area.
View view_of(const Corners& t) {
    for (const View view : {View::yz, View::zx}) {
        if (orient_seen(view, t[0], t[1], t[2]) != 0) return view;
    }
    return View::xy;
}

/// True when the line through an edge of `a` has all of `b` beyond it; with
/// `limit` 0 points on the line count as beyond it too.
bool edge_separates(View view, const Corners& a, const Corners& b, int limit) {
    const int turn = orient_seen(view, a[0], a[1], a[2]);
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3& from = a[i];
        const Double3& to = a[(i + 1) % 3];
        const bool beyond = std::all_of(b.begin(), b.end(), [&](const Double3& p) {
            return turn * orient_seen(view, from, to, p) <= limit;
        });
        if (beyond) return true;
    }
    return false;
}

/// Two triangles with area in one plane are disjoint exactly when an edge of
/// one separates them strictly, and share no area when one separates weakly.
TriangleContact coplanar_contact(const Corners& a, const Corners& b) {
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

/// A segment; equal ends are a point.
struct Segment {
    Double3 from;
    Double3 to;
};

bool precedes(const Double3& a, const Double3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

/// What three collinear corners span: along a line the order of coordinates is
/// the order on the line.
Segment span_of(const Corners& t) {
    const auto [least, greatest] = std::minmax_element(t.begin(), t.end(), precedes);
    return {*least, *greatest};
}

bool within(double x, double a, double b) {
    return std::min(a, b) <= x && x <= std::max(a, b);
}

/// Whether p, known to be collinear with the segment, lies on it.
bool between(const Double3& p, const Segment& s) {
    return within(p.x, s.from.x, s.to.x) && within(p.y, s.from.y, s.to.y) &&
           within(p.z, s.from.z, s.to.z);
}

bool collinear(const Double3& a, const Double3& b, const Double3& c) {
    return orient_seen(View::yz, a, b, c) == 0 && orient_seen(View::zx, a, b, c) == 0 &&
           orient_seen(View::xy, a, b, c) == 0;
}

/// Two segments in one plane, seen where that plane keeps its area.
bool segments_touch_seen(View view, const Segment& s, const Segment& t) {
    const int s1 = orient_seen(view, s.from, s.to, t.from);
    const int s2 = orient_seen(view, s.from, s.to, t.to);
    const int t1 = orient_seen(view, t.from, t.to, s.from);
    const int t2 = orient_seen(view, t.from, t.to, s.to);
    if (s1 * s2 < 0 && t1 * t2 < 0) return true;
    return (s1 == 0 && between(t.from, s)) || (s2 == 0 && between(t.to, s)) ||
           (t1 == 0 && between(s.from, t)) || (t2 == 0 && between(s.to, t));
}

/// A segment and a triangle with area, both in one plane.
bool touches_in_plane(const Segment& s, const Corners& t) {
    const View view = view_of(t);
    const int turn = orient_seen(view, t[0], t[1], t[2]);
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Segment edge{t[i], t[(i + 1) % 3]};
        if (segments_touch_seen(view, s, edge)) return true;
        inside = inside && turn * orient_seen(view, edge.from, edge.to, s.from) > 0;
    }
    return inside;
}

/// A segment and a triangle with area: one end on either side of the plane, and
/// the line through both passes the three edges on one side (Feito and Torres'
/// signed volumes).
bool segment_touches(const Segment& s, const Corners& t) {
    const int from = orient3d(t[0], t[1], t[2], s.from);
    const int to = orient3d(t[0], t[1], t[2], s.to);
    if (from * to > 0) return false;
    if (from == 0 && to == 0) return touches_in_plane(s, t);
    const int e0 = orient3d(s.from, s.to, t[0], t[1]);
    const int e1 = orient3d(s.from, s.to, t[1], t[2]);
    const int e2 = orient3d(s.from, s.to, t[2], t[0]);
    return !(std::min({e0, e1, e2}) < 0 && std::max({e0, e1, e2}) > 0);
}

/// Two segments anywhere in space.
bool segments_touch(const Segment& s, const Segment& t) {
    if (orient3d(s.from, s.to, t.from, t.to) != 0) return false;
    const std::array<Double3, 4> points = {s.from, s.to, t.from, t.to};
    for (const View view : {View::yz, View::zx, View::xy}) {
        for (std::size_t skipped = 0; skipped < 4; ++skipped) {
            const Double3& a = points[(skipped + 1) % 4];
            const Double3& b = points[(skipped + 2) % 4];
            const Double3& c = points[(skipped + 3) % 4];
            if (orient_seen(view, a, b, c) != 0) return segments_touch_seen(view, s, t);
        }
    }
    return between(s.from, t) || between(s.to, t) || between(t.from, s);  // all on one line
}

/// For pairs of which at least one has no area.
bool degenerate_touch(const Corners& a, bool a_is_flat, const Corners& b, bool b_is_flat) {
    if (a_is_flat && b_is_flat) return segments_touch(span_of(a), span_of(b));
    return a_is_flat ? segment_touches(span_of(a), b) : segment_touches(span_of(b), a);
}

/// For pairs where all corners of one have sign 0: the planes coincide, or a
/// triangle without area has none.
TriangleContact flat_contact(const Corners& a, const Corners& b) {
    const bool a_is_flat = is_degenerate(a);
    const bool b_is_flat = is_degenerate(b);
    if (!a_is_flat && !b_is_flat) return coplanar_contact(a, b);
    return degenerate_touch(a, a_is_flat, b, b_is_flat) ? TriangleContact::touch
                                                        : TriangleContact::disjoint;
}

}  // namespace

bool is_degenerate(const Corners& t) noexcept {
    return collinear(t[0], t[1], t[2]);
}

TriangleContact classify_contact(const Corners& a, const Corners& b) noexcept {
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

bool triangles_touch(const Corners& a, const Corners& b) noexcept {
    return classify_contact(a, b) != TriangleContact::disjoint;
}

bool triangles_touch_by_segments(const Corners& a, const Corners& b) noexcept {
    const bool a_is_flat = is_degenerate(a);
    const bool b_is_flat = is_degenerate(b);
    if (a_is_flat || b_is_flat) return degenerate_touch(a, a_is_flat, b, b_is_flat);
    for (std::size_t i = 0; i < 3; ++i) {
        if (segment_touches({a[i], a[(i + 1) % 3]}, b)) return true;
        if (segment_touches({b[i], b[(i + 1) % 3]}, a)) return true;
    }
    return false;
}

}  // namespace cdprep
