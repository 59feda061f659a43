// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/growing_hull.h"

#include <algorithm>
#include <utility>

#include "cdprep/exact/predicates.h"

namespace cdprep::convex {
namespace {

/// The sides of a plane that contain points.
struct Sides {
    bool behind = false;
    bool before = false;
    void add(int sign) {
        behind = behind || sign > 0;
        before = before || sign < 0;
    }
    [[nodiscard]] bool both() const {
        return behind && before;
    }
    [[nodiscard]] bool one() const {
        return behind != before;
    }
};

/// Returns whether the two are on different sides of their plane, or in it.
bool parted(const Sides& a, const Sides& b) {
    return a.one() && !(a.behind && b.behind) && !(a.before && b.before);
}

}  // namespace

int GrowingHull::side(const Facet& facet, const Double3& p) const {
    return exact::orient3d(points_[facet.corner[0]], points_[facet.corner[1]],
                           points_[facet.corner[2]], p);
}

bool GrowingHull::find_start(std::array<std::uint32_t, 4>& start) const {
    const auto count = static_cast<std::uint32_t>(points_.size());
    std::uint32_t third = 2;
    while (third < count && exact::is_degenerate({points_[0], points_[1], points_[third]})) ++third;
    if (third >= count) return false;
    for (std::uint32_t i = 2; i < count; ++i) {
        const int sign = exact::orient3d(points_[0], points_[1], points_[third], points_[i]);
        if (sign == 0) continue;
        start = {0, 1, third, i};
        if (sign < 0) std::swap(start[0], start[1]);
        return true;
    }
    return false;
}

void GrowingHull::begin_with(const std::array<std::uint32_t, 4>& start) {
    const auto& [a, b, c, d] = start;  // d is behind a, b, c
    facets_ = {{{a, b, c}, {1, 2, 3}},
               {{b, a, d}, {0, 3, 2}},
               {{c, b, d}, {0, 1, 3}},
               {{a, c, d}, {0, 2, 1}}};
}

bool GrowingHull::build(std::span<const Double3> points) {
    points_.assign(points.begin(), points.end());
    facets_.clear();
    unused_.clear();
    std::array<std::uint32_t, 4> start{};
    if (!find_start(start)) return false;
    begin_with(start);
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        if (std::find(start.begin(), start.end(), i) == start.end()) take_in(i);
    }
    return true;
}

void GrowingHull::adopt(std::span<const Double3> points,
                        std::span<const std::array<std::uint32_t, 3>> triangles) {
    points_.assign(points.begin(), points.end());
    facets_.clear();
    unused_.clear();
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sides;  // the ends of an edge, 3 f + k
    for (const auto& corner : triangles) {
        const auto f = static_cast<std::uint32_t>(facets_.size());
        facets_.push_back({corner, {}});
        for (std::uint32_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(corner[k], corner[(k + 1) % 3]);
            sides.push_back({(std::uint64_t{low} << 32U) | high, 3 * f + k});
        }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
        const std::uint32_t a = sides[i].second, b = sides[i + 1].second;
        facets_[a / 3].across[a % 3] = b / 3;
        facets_[b / 3].across[b % 3] = a / 3;
    }
}

void GrowingHull::add(const Double3& point) {
    points_.push_back(point);
    take_in(static_cast<std::uint32_t>(points_.size() - 1));
}

// Facets whose plane contains the point are not visible. So the visible facets are whole faces
// and form a disk. No facet between an edge of its rim and the point is degenerate. A point in line
// with the edge would lie in the plane of the visible facet too.
void GrowingHull::take_in(std::uint32_t point) {
    visible_.assign(facets_.size(), 0);
    bool any = false;
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
        if (facets_[f].corner[0] == kDead) continue;
        visible_[f] = side(facets_[f], points_[point]) < 0 ? 1 : 0;
        any = any || visible_[f] != 0;
    }
    if (!any) return;
    ring_.clear();  // 4 numbers per edge: from, to, the facet beyond, its edge there
    for (std::uint32_t f = 0; f < visible_.size(); ++f) {
        if (visible_[f] == 0) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t beyond = facets_[f].across[k];
            if (visible_[beyond] != 0) continue;
            const auto& back = facets_[beyond].across;
            const auto edge =
                static_cast<std::uint32_t>(std::find(back.begin(), back.end(), f) - back.begin());
            ring_.insert(ring_.end(),
                         {facets_[f].corner[k], facets_[f].corner[(k + 1) % 3], beyond, edge});
        }
    }
    for (std::uint32_t f = 0; f < visible_.size(); ++f) {
        if (visible_[f] == 0) continue;
        facets_[f].corner[0] = kDead;
        unused_.push_back(f);
    }
    facet_from_.resize(points_.size());
    for (std::size_t i = 0; i < ring_.size(); i += 4) {
        if (unused_.empty()) {
            unused_.push_back(static_cast<std::uint32_t>(facets_.size()));
            facets_.push_back({});
        }
        const std::uint32_t f = unused_.back();
        unused_.pop_back();
        facets_[f] = {{ring_[i], ring_[i + 1], point}, {ring_[i + 2], kDead, kDead}};
        facets_[ring_[i + 2]].across[ring_[i + 3]] = f;
        facet_from_[ring_[i]] = f;
    }
    for (std::size_t i = 0; i < ring_.size(); i += 4) {
        const std::uint32_t f = facet_from_[ring_[i]], next = facet_from_[ring_[i + 1]];
        facets_[f].across[1] = next;
        facets_[next].across[2] = f;
    }
}

// If no point of a triangle lies inside a hull of dimension 3, a plane separates the two. One of
// these planes touches the two in three of their corners, not collinear. The three corners are
// of one of these kinds:
// - Three of the hull: the plane is that of a facet.
// - Three of the triangle.
// - Two of one and one of the other. The two are an edge of the first, or two corners of one of its
//   facets.
// Each kind is tested, with exact signs of corners only.
bool GrowingHull::has_inside(const Corners& triangle) const {
    bool has_corner_inside = false;
    if (is_parted_by_facet(triangle, has_corner_inside)) return false;
    if (has_corner_inside) return true;
    return !is_parted_by_plane(triangle) && !is_parted_at_hull_edge(triangle) &&
           !is_parted_at_triangle_edge(triangle);
}

bool GrowingHull::is_parted_by_facet(const Corners& triangle, bool& has_corner_inside) const {
    std::array<bool, 3> inside = {true, true, true};
    for (const Facet& facet : facets_) {
        if (facet.corner[0] == kDead) continue;
        bool all_outside = true;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool behind = side(facet, triangle[i]) > 0;
            all_outside = all_outside && !behind;
            inside[i] = inside[i] && behind;
        }
        if (all_outside) return true;
    }
    has_corner_inside = inside[0] || inside[1] || inside[2];
    return false;
}

bool GrowingHull::is_parted_by_plane(const Corners& triangle) const {
    Sides sides;
    for (const Double3& p : points_) {
        sides.add(exact::orient3d(triangle[0], triangle[1], triangle[2], p));
        if (sides.both()) return false;
    }
    return sides.one();
}

bool GrowingHull::is_parted_at_hull_edge(const Corners& triangle) const {
    for (const Facet& facet : facets_) {
        if (facet.corner[0] == kDead) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Facet& beyond = facets_[facet.across[k]];
            const std::uint32_t from = facet.corner[k], to = facet.corner[(k + 1) % 3];
            if (from > to) continue;
            std::uint32_t apex = beyond.corner[0];
            for (const std::uint32_t corner : beyond.corner) {
                if (corner != from && corner != to) apex = corner;
            }
            const Double3 &u = points_[from], &w = points_[to];
            for (std::size_t i = 0; i < 3; ++i) {
                Sides hull, others;
                hull.add(exact::orient3d(u, w, triangle[i], points_[facet.corner[(k + 2) % 3]]));
                hull.add(exact::orient3d(u, w, triangle[i], points_[apex]));
                if (!hull.one()) continue;
                others.add(exact::orient3d(u, w, triangle[i], triangle[(i + 1) % 3]));
                others.add(exact::orient3d(u, w, triangle[i], triangle[(i + 2) % 3]));
                if (parted(hull, others)) return true;
            }
        }
    }
    return false;
}

bool GrowingHull::is_parted_at_triangle_edge(const Corners& triangle) const {
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3 &a = triangle[i], &b = triangle[(i + 1) % 3];
        for (const Double3& corner : points_) {
            Sides hull, others;
            for (const Double3& p : points_) {
                hull.add(exact::orient3d(a, b, corner, p));
                if (hull.both()) break;
            }
            others.add(exact::orient3d(a, b, corner, triangle[(i + 2) % 3]));
            if (parted(hull, others)) return true;
        }
    }
    return false;
}

}  // namespace cdprep::convex
