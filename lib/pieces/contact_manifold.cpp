// SPDX-License-Identifier: MIT
#include "pieces/contact_steps.h"

#include <algorithm>
#include <cmath>

#include "hull/hull_edges.h"

namespace cdprep {
namespace {

constexpr std::size_t kMostOutline = 64;  ///< corners kept of a face
/// The cosine above which a face counts as perpendicular to the contact normal. Rounding turns
/// neither that far.
constexpr double kAcross = 1 - 1e-10;

/// Corners of a convex polygon, counter-clockwise as seen from the tip of `normal`.
struct Polygon {
    std::array<Double3, 2 * kMostOutline> at;
    std::size_t count = 0;
    Double3 normal{};

    void add(const Double3& p) noexcept {
        if (count < at.size()) at[count++] = p;
    }
};

Polygon triangle_polygon(const ContactSide& side, std::uint32_t triangle,
                         const Double3& direction) {
    const Corners t = side.model().corners(triangle);
    Polygon polygon;
    polygon.normal = unit_normal(t);
    for (const Double3& p : t) polygon.add(p);
    if (dot(polygon.normal, direction) < 0) {
        polygon.normal = -polygon.normal;
        std::swap(polygon.at[1], polygon.at[2]);
    }
    return polygon;
}

/// Returns the corners of a face or, if there are too many, an even selection of them: a part of
/// the face. `normal` may be that of its back.
Polygon face_polygon(const ContactSide& side, std::uint32_t first, const Double3& normal) {
    const HullEdges edges(side.facets(), side.adjacency());
    std::size_t all = 0;
    edges.each_around_face(first, [&](const FacetPlace&) { ++all; });
    Polygon polygon;
    polygon.normal = normal;
    const std::size_t kept = std::min(all, kMostOutline);
    std::size_t i = 0;
    edges.each_around_face(first, [&](const FacetPlace& p) {
        if (i == 0 || i * kept / all != (i - 1) * kept / all) {
            polygon.add(side.corner(edges.start(p)));
        }
        ++i;
    });
    const auto& c = side.facets()[first].corner;
    const Corners front = {side.corner(c[0]), side.corner(c[1]), side.corner(c[2])};
    if (dot(unit_normal(front), normal) < 0) {
        std::reverse(polygon.at.begin(),
                     polygon.at.begin() + static_cast<std::ptrdiff_t>(polygon.count));
    }
    return polygon;
}

/// Returns the face that faces a direction most: a face of the hull if triangles cover it,
/// otherwise the feature's own triangle.
Polygon facing(const ContactSide& side, const PieceFeature& feature, const Double3& direction) {
    const Polygon own = triangle_polygon(side, feature.triangle, direction);
    std::optional<std::uint32_t> best;
    double most = dot(own.normal, direction) - 1e-12;  // prefers the whole face to its part
    Double3 normal = own.normal;
    const auto facets = side.facets();
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
        if (facets[f].flags != format::facet_first_of_face) continue;
        const auto& c = facets[f].corner;
        const Double3 n = unit_normal({side.corner(c[0]), side.corner(c[1]), side.corner(c[2])});
        const double along = dot(n, direction);
        // A surface that bounds no solid can be met from either side.
        const double faces = side.is_contained() ? along : std::fabs(along);
        if (faces > most) most = faces, best = f, normal = along < 0 ? -n : n;
    }
    if (!best) return own;
    const Polygon whole = face_polygon(side, *best, normal);
    return whole.count < 3 ? own : whole;  // flags of a damaged file may leave no outline
}

/// Returns the part of a polygon where dot(inward, p - on) >= 0.
Polygon clipped(const Polygon& polygon, const Double3& on, const Double3& inward) {
    Polygon result;
    result.normal = polygon.normal;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Double3 &p = polygon.at[i], &q = polygon.at[(i + 1) % polygon.count];
        const double at_p = dot(inward, p - on), at_q = dot(inward, q - on);
        if (at_p >= 0) result.add(p);
        if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
            result.add(p + at_p / (at_p - at_q) * (q - p));
        }
    }
    return result;
}

/// Returns the part of a polygon that is over another one, seen along the other's normal.
Polygon over(const Polygon& base, Polygon polygon) {
    for (std::size_t i = 0; i < base.count && polygon.count > 0; ++i) {
        const Double3 &p = base.at[i], &q = base.at[(i + 1) % base.count];
        polygon = clipped(polygon, p, cross(base.normal, q - p));
    }
    return polygon;
}

/// Points of a contact before the choice of four.
class Candidates {
public:
    void add(const ManifoldPoint& point) noexcept {
        if (count_ < point_.size()) point_[count_++] = point;
    }
    [[nodiscard]] std::size_t count() const noexcept {
        return count_;
    }

    /// Takes the deepest point, the one farthest from it, and those with the largest triangles on
    /// either side of the line between. Of equal points it takes the first.
    void choose(Contact& contact) const noexcept {
        const std::size_t first = best([&](const ManifoldPoint& p) { return -p.distance; });
        take(first, contact);
        const Double3 origin = point_[first].on_a;
        const std::size_t second = best([&](const ManifoldPoint& p) {
            const Double3 d = p.on_a - origin;
            return dot(d, d);
        });
        const Double3 line = point_[second].on_a - origin;
        if (!(dot(line, line) > 0)) return;
        take(second, contact);
        for (const double side : {1.0, -1.0}) {
            const auto area = [&](const ManifoldPoint& p) {
                return side * dot(contact.normal, cross(line, p.on_a - origin));
            };
            const std::size_t third = best(area);
            // A smaller area is rounding: no point is beside the line.
            if (area(point_[third]) > 1e-12 * dot(line, line)) take(third, contact);
        }
    }

private:
    template <class Score>
    [[nodiscard]] std::size_t best(Score&& score) const noexcept {
        std::size_t best = 0;
        for (std::size_t i = 1; i < count_; ++i) {
            if (score(point_[i]) > score(point_[best])) best = i;
        }
        return best;
    }
    void take(std::size_t i, Contact& contact) const noexcept {
        contact.points[contact.point_count++] = point_[i];
    }

    std::array<ManifoldPoint, 2 * kMostOutline> point_;
    std::size_t count_ = 0;
};

}  // namespace

void add_manifold(const ContactSide& a, const ContactSide& b, const PieceFeature& feature_a,
                  const PieceFeature& feature_b, double tolerance, Contact& contact) noexcept {
    const Double3 n = contact.normal;
    const Polygon of_a = facing(a, feature_a, n), of_b = facing(b, feature_b, -n);
    const double across_a = dot(of_a.normal, n), across_b = -dot(of_b.normal, n);
    Candidates candidates;
    const bool a_is_base = across_a >= across_b;
    if (std::max(across_a, across_b) >= kAcross) {
        const Polygon& base = a_is_base ? of_a : of_b;
        const Polygon part = over(base, a_is_base ? of_b : of_a);
        for (std::size_t i = 0; i < part.count; ++i) {
            const Double3& p = part.at[i];
            const double height = dot(base.normal, p - base.at[0]);
            const Double3 foot = p - height * base.normal;
            if (height > tolerance) continue;
            candidates.add(a_is_base ? ManifoldPoint{foot, p, height}
                                     : ManifoldPoint{p, foot, height});
        }
    }
    contact.point_count = 0;
    if (candidates.count() == 0) {
        candidates.add(
            {contact.point_a, contact.point_b, dot(n, contact.point_b - contact.point_a)});
    }
    candidates.choose(contact);
}

}  // namespace cdprep
