// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/triangle_meeting.h"

#include "cdprep/exact/predicates.h"

namespace cdprep::mesh {
namespace {

using Signs = std::array<int, 3>;

/// Returns whether the segment passes through the interior of the triangle. No end may lie in
/// its plane.
bool pierces(const Double3& from, const Double3& to, const Corners& t) {
    const int e0 = exact::orient3d(from, to, t[0], t[1]);
    if (e0 == 0) return false;
    return exact::orient3d(from, to, t[1], t[2]) == e0 &&
           exact::orient3d(from, to, t[2], t[0]) == e0;
}

bool an_edge_pierces(const Corners& a, const Corners& b) {
    const Signs sides = exact::plane_signs(b, a);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (sides[i] * sides[next] < 0 && pierces(a[i], a[next], b)) return true;
    }
    return false;
}

/// Returns whether b lies in the plane of a; a must have area.
bool in_one_plane(const Corners& a, const Corners& b) {
    return exact::plane_signs(a, b) == Signs{0, 0, 0};
}

/// Returns whether two points on a line through `from` lie on the same side of it. Neither may
/// equal it.
bool same_way(const Double3& from, const Double3& p, const Double3& q) {
    if (p.x != from.x) return (p.x > from.x) == (q.x > from.x);
    if (p.y != from.y) return (p.y > from.y) == (q.y > from.y);
    return (p.z > from.z) == (q.z > from.z);
}

/// Returns whether edges from the common corner overlap.
bool edges_overlap(const Corners& a, const Corners& b) {
    for (const std::size_t i : {1, 2}) {
        for (const std::size_t j : {1, 2}) {
            if (exact::is_degenerate({a[0], a[i], b[j]}) && same_way(a[0], a[i], b[j])) return true;
        }
    }
    return false;
}

std::optional<Meeting> flat_meeting_at_corner(const Corners& a, const Corners& b) {
    if (exact::classify_contact(a, b) == TriangleContact::coplanar_overlap) return Meeting::fold;
    // The sectors share no area, so at most a ray remains.
    return edges_overlap(a, b) ? std::optional(Meeting::edge_overlap) : std::nullopt;
}

int sign_of(int value) {
    return (value > 0) - (value < 0);
}

}  // namespace

Meeting meeting_across(const Corners& a, const Corners& b) noexcept {
    return an_edge_pierces(a, b) || an_edge_pierces(b, a) ? Meeting::crossing
                                                          : Meeting::edge_crossing;
}

std::optional<Meeting> meeting_apart(const Corners& a, const Corners& b) noexcept {
    switch (exact::classify_contact(a, b)) {
        case TriangleContact::disjoint:
            return std::nullopt;
        case TriangleContact::touch:
            return in_one_plane(a, b) ? Meeting::flat_touching : Meeting::touching;
        case TriangleContact::cross:
            return meeting_across(a, b);
        default:
            return Meeting::coplanar_overlap;
    }
}

// Both planes meet in a line through the common corner v. Triangle a extends along it from v to
// where its far edge meets the plane of b, and b likewise. They meet elsewhere if both extend in
// the same direction. Let n_a and n_b be the normals, each from a corner v, p, q. From p to q, a
// turns counter-clockwise about n_a. Let p be above the plane of b (along n_b), and q not. Then
// a passes the line on the side of n_a x n_b. For b, with the two exchanged, it is the side of
// n_b x n_a. orient3d() is positive below, for both alike.
std::optional<Meeting> meeting_at_corner(const Corners& a, const Corners& b) noexcept {
    const int a1 = exact::orient3d(b[0], b[1], b[2], a[1]);
    const int a2 = exact::orient3d(b[0], b[1], b[2], a[2]);
    if (a1 == a2) return a1 == 0 ? flat_meeting_at_corner(a, b) : std::nullopt;
    const int b1 = exact::orient3d(a[0], a[1], a[2], b[1]);
    const int b2 = exact::orient3d(a[0], a[1], a[2], b[2]);
    if (b1 == b2) return std::nullopt;
    const bool reach_alike = sign_of(a1 - a2) == -sign_of(b1 - b2);
    return reach_alike ? std::optional(Meeting::corner_crossing) : std::nullopt;
}

std::optional<Meeting> meeting_at_edge(const Corners& a, const Corners& b) noexcept {
    if (exact::orient3d(a[0], a[1], a[2], b[2]) != 0) return std::nullopt;
    const bool overlap = exact::classify_contact(a, b) == TriangleContact::coplanar_overlap;
    return overlap ? std::optional(Meeting::fold) : std::nullopt;
}

}  // namespace cdprep::mesh
