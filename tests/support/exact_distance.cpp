// SPDX-License-Identifier: MIT
#include "support/exact_distance.h"

#include <algorithm>

#include "support/exact_contact.h"
#include "support/exact_pairs.h"

namespace cdprep::test {
namespace {

using Vector = ExactPoint<ExactNumber>;

/// Corners relative to q: the distance sought is that from the origin.
ExactRational squared_distance_to_segment(const Vector& a, const Vector& b) {
    const Vector edge = minus(b, a);
    const ExactNumber along = -dot(a, edge);  // of the foot, times |edge|^2
    const ExactNumber squared = dot(edge, edge);
    if (along.sign() <= 0) return {dot(a, a), 1.0};
    if (along >= squared) return {dot(b, b), 1.0};
    return {dot(a, a) * squared - along * along, squared};
}

/// The square of the distance of the two lines, when both feet lie within the
/// segments; `best` else. Ends are for the corners to answer.
ExactRational nearer_inside(const Vector& p, const Vector& p_end, const Vector& q,
                            const Vector& q_end, const ExactRational& best) {
    const Vector u = minus(p_end, p);
    const Vector v = minus(q_end, q);
    const Vector r = minus(p, q);
    const Vector n = cross(u, v);
    if (is_zero(n)) return best;
    const ExactNumber denominator = dot(n, n);
    const ExactNumber s = dot(u, v) * dot(v, r) - dot(u, r) * dot(v, v);
    const ExactNumber t = dot(u, u) * dot(v, r) - dot(u, v) * dot(u, r);
    const bool inside = s.sign() >= 0 && s <= denominator && t.sign() >= 0 && t <= denominator;
    if (!inside) return best;
    const ExactNumber height = dot(n, r);
    return std::min(best, ExactRational(height * height, denominator));
}

}  // namespace

ExactRational exact_squared_distance(const Corners& a, const Corners& b) {
    if (exact_contact(a, b) != TriangleContact::disjoint) return 0.0;
    ExactRational best = exact_squared_distance(a[0], b);
    for (std::size_t i = 0; i < 3; ++i) {
        best = std::min({best, exact_squared_distance(a[i], b), exact_squared_distance(b[i], a)});
    }
    const ExactTriangle<ExactNumber> s = exact<ExactNumber>(a);
    const ExactTriangle<ExactNumber> t = exact<ExactNumber>(b);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            best = nearer_inside(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3], best);
        }
    }
    return best;
}

ExactRational exact_squared_distance(const Double3& q, const Corners& corners) {
    const ExactTriangle<ExactNumber> t = exact<ExactNumber>(corners);
    const Vector origin = {q.x, q.y, q.z};
    const std::array<Vector, 3> v = {minus(t[0], origin), minus(t[1], origin), minus(t[2], origin)};
    const Vector n = cross(minus(v[1], v[0]), minus(v[2], v[0]));
    bool above = !is_zero(n);  // the foot of the origin lies in the triangle
    ExactRational best = squared_distance_to_segment(v[2], v[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector& from = v[i];
        const Vector& to = v[(i + 1) % 3];
        best = std::min(best, squared_distance_to_segment(from, to));
        above = above && dot(n, cross(from, to)).sign() >= 0;
    }
    if (!above) return best;
    const ExactNumber height = dot(n, v[0]);
    return std::min(best, ExactRational(height * height, dot(n, n)));
}

}  // namespace cdprep::test
