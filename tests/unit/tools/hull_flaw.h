// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "hull/convex_hull.h"
#include "support/exact_rational.h"

#include "exact/predicates.h"

namespace cdprep::test {

using format::Double3;
using HullFacet = std::array<std::uint32_t, 3>;
using ExactVector = std::array<ExactNumber, 3>;

inline ExactVector exact_difference(const Double3& a, const Double3& b) {
    return {ExactNumber(a.x) - ExactNumber(b.x), ExactNumber(a.y) - ExactNumber(b.y),
            ExactNumber(a.z) - ExactNumber(b.z)};
}

inline ExactVector exact_cross(const ExactVector& a, const ExactVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline ExactNumber exact_dot(const ExactVector& a, const ExactVector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The plane of three points, its normal towards who sees them counter-clockwise.
struct ExactPlane {
    Double3 at;
    ExactVector normal;
    /// 1 in front of the plane, 0 on it, -1 behind it.
    [[nodiscard]] int side(const Double3& p) const {
        return exact_dot(normal, exact_difference(p, at)).sign();
    }
    [[nodiscard]] bool degenerate() const {
        return normal[0].sign() == 0 && normal[1].sign() == 0 && normal[2].sign() == 0;
    }
};

inline ExactPlane exact_plane(const Double3& a, const Double3& b, const Double3& c) {
    return {a, exact_cross(exact_difference(b, a), exact_difference(c, a))};
}

/// side() of many points, where doubles settle those that are far from the plane: the
/// rounded value is off by less than 2^-40 of the sum of the terms' magnitudes, for
/// coordinates below 2^100 whose products do not overflow, unless that is next to nothing.
class FilteredPlane {
public:
    FilteredPlane(const Double3& a, const Double3& b, const Double3& c)
        : exact_(exact_plane(a, b, c)) {
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        normal_ = {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
        size_ = {std::fabs(uy * vz) + std::fabs(uz * vy), std::fabs(uz * vx) + std::fabs(ux * vz),
                 std::fabs(ux * vy) + std::fabs(uy * vx)};
    }
    [[nodiscard]] int side(const Double3& p) const {
        const double x = p.x - exact_.at.x, y = p.y - exact_.at.y, z = p.z - exact_.at.z;
        const double height = normal_.x * x + normal_.y * y + normal_.z * z;
        const double most =
            size_.x * std::fabs(x) + size_.y * std::fabs(y) + size_.z * std::fabs(z);
        constexpr double kNoUnderflow = 0x1p-900;
        if (most < kNoUnderflow) return exact_.side(p);
        if (height < -0x1p-40 * most) return -1;
        if (height > 0x1p-40 * most) return 1;
        return exact_.side(p);
    }

    /// About how far behind the plane a point is; no more than that where the plane's
    /// terms cancel much.
    [[nodiscard]] double depth(const Double3& p) const {
        const double x = p.x - exact_.at.x, y = p.y - exact_.at.y, z = p.z - exact_.at.z;
        const double height = normal_.x * x + normal_.y * y + normal_.z * z;
        const double most =
            size_.x * std::fabs(x) + size_.y * std::fabs(y) + size_.z * std::fabs(z);
        const double length = std::hypot(normal_.x, normal_.y, normal_.z);
        const double least = (-height - 0x1p-40 * most) / (length * (1 + 0x1p-40));
        return least > 0 ? least : 0;  // 0 where something left the range
    }

private:
    ExactPlane exact_;
    Double3 normal_ = {};
    Double3 size_ = {};
};

/// Returns true if no facet of a solid hull has p in front of it.
inline bool holds(const convex::ConvexHull& hull, const Double3& p) {
    return std::all_of(hull.facets.begin(), hull.facets.end(), [&](const HullFacet& f) {
        return orient3d(hull.points[f[0]], hull.points[f[1]], hull.points[f[2]], p) >= 0;
    });
}

/// What a hull must be, checked with exact numbers and by nothing that it was made with.
class HullJudge {
public:
    HullJudge(std::span<const Double3> input, const convex::ConvexHull& hull)
        : input_(input), hull_(hull) {}

    /// What is wrong, or nothing.
    [[nodiscard]] std::string flaw() {
        if (const std::string found = points_flaw(); !found.empty()) return found;
        if (const std::string found = groups_flaw(); !found.empty()) return found;
        if (hull_.dimension < 2) return segment_flaw();
        if (const std::string found = surface_flaw(); !found.empty()) return found;
        if (const std::string found = convexity_flaw(); !found.empty()) return found;
        return containment_flaw();
    }

private:
    static std::string at(const char* what, std::size_t number) {
        return std::string(what) + " " + std::to_string(number);
    }
    [[nodiscard]] const Double3& corner(const HullFacet& facet, std::size_t i) const {
        return hull_.points[facet[i]];
    }
    [[nodiscard]] ExactPlane plane(const HullFacet& facet) const {
        return exact_plane(corner(facet, 0), corner(facet, 1), corner(facet, 2));
    }

    [[nodiscard]] std::string points_flaw() const {
        if (hull_.numbers.size() != hull_.points.size()) return "not one number a point";
        if (!std::is_sorted(hull_.numbers.begin(), hull_.numbers.end())) return "numbers unsorted";
        for (std::size_t i = 0; i < hull_.points.size(); ++i) {
            const Double3 &p = hull_.points[i], &q = input_[hull_.numbers[i]];
            if (p.x != q.x || p.y != q.y || p.z != q.z) return at("not its input point:", i);
        }
        return {};
    }

    [[nodiscard]] std::string groups_flaw() {
        if (hull_.groups.empty() || hull_.groups.front() != 0) return "no first group";
        if (hull_.groups.back() != hull_.facets.size()) return "groups do not end at the facets";
        group_of_.assign(hull_.facets.size(), 0);
        HullFacet before = {};
        for (std::size_t g = 0; g + 1 < hull_.groups.size(); ++g) {
            if (hull_.groups[g] >= hull_.groups[g + 1]) return at("empty group", g);
            if (g > 0 && !(before < hull_.facets[hull_.groups[g]])) return at("unsorted group", g);
            before = hull_.facets[hull_.groups[g]];
            for (std::size_t f = hull_.groups[g]; f < hull_.groups[g + 1]; ++f) group_of_[f] = g;
        }
        return {};
    }

    /// Dimension below 2: every input point is on the segment, between its ends.
    [[nodiscard]] std::string segment_flaw() const {
        if (hull_.points.size() != static_cast<std::size_t>(hull_.dimension + 1)) {
            return "wrong number of ends";
        }
        if (!hull_.facets.empty()) return "facets of a segment";
        for (std::size_t i = 0; i < input_.size(); ++i) {
            const Double3 &a = hull_.points.front(), &b = hull_.points.back();
            if (!exact_plane(a, b, input_[i]).degenerate()) return at("not collinear:", i);
            const ExactNumber inside =
                exact_dot(exact_difference(input_[i], a), exact_difference(input_[i], b));
            if (inside.sign() > 0) return at("beyond an end:", i);
        }
        return {};
    }

    /// Closed, of genus 0, every point used, no facet degenerate, canonical.
    [[nodiscard]] std::string surface_flaw() {
        std::set<std::uint32_t> used;
        for (std::size_t f = 0; f < hull_.facets.size(); ++f) {
            const HullFacet& facet = hull_.facets[f];
            if (facet[0] != *std::min_element(facet.begin(), facet.end())) return at("turned:", f);
            if (f > 0 && group_of_[f] == group_of_[f - 1] && !(hull_.facets[f - 1] < facet)) {
                return at("unsorted facet", f);
            }
            if (plane(facet).degenerate()) return at("degenerate facet", f);
            for (std::size_t i = 0; i < 3; ++i) {
                used.insert(facet[i]);
                const std::array<std::uint32_t, 2> edge = {facet[i], facet[(i + 1) % 3]};
                if (!facet_left_.emplace(edge, f).second) return at("edge used twice, facet", f);
            }
        }
        const std::size_t points = hull_.points.size();
        if (used.size() != points) return "a point without a facet";
        if (hull_.facets.size() != 2 * points - 4) return "V - E + F is not 2";
        return {};
    }

    /// Every edge convex or, within a group, flat; the groups' corners real ones.
    [[nodiscard]] std::string convexity_flaw() const {
        for (const auto& [edge, f] : facet_left_) {
            const auto other = facet_left_.find({edge[1], edge[0]});
            if (other == facet_left_.end()) return at("open edge, facet", f);
            const HullFacet& facet = hull_.facets[other->second];
            std::uint32_t far = facet[0];
            for (const std::uint32_t p : facet) {
                if (p != edge[0] && p != edge[1]) far = p;
            }
            const int side = plane(hull_.facets[f]).side(hull_.points[far]);
            const bool same = group_of_[f] == group_of_[other->second];
            if (side > 0) return at("reflex edge, facet", f);
            if (hull_.dimension == 3 && (side == 0) != same) return at("wrong group, facet", f);
            if (hull_.dimension == 2 && side != 0) return at("not flat, facet", f);
        }
        return corner_flaw();
    }

    /// A point is a corner if its facets span three planes; in a polygon, if the border
    /// turns there.
    [[nodiscard]] std::string corner_flaw() const {
        std::map<std::uint32_t, std::vector<std::array<std::uint32_t, 2>>> border;
        for (const auto& [edge, f] : facet_left_) {
            if (group_of_[f] == group_of_[facet_left_.at({edge[1], edge[0]})]) continue;
            border[edge[0]].push_back(edge);
        }
        for (std::uint32_t p = 0; p < hull_.points.size(); ++p) {
            const auto& around = border[p];
            if (around.size() < (hull_.dimension == 2 ? 2U : 3U)) return at("no corner:", p);
            if (around.size() == 2 &&
                exact_plane(hull_.points[p], hull_.points[around[0][1]], hull_.points[around[1][1]])
                    .degenerate()) {
                return at("no turn:", p);
            }
        }
        return {};
    }

    [[nodiscard]] std::string containment_flaw() const {
        const std::vector<std::uint32_t> doubtful = outside_inner_ball();
        for (std::size_t g = 0; g + 1 < hull_.groups.size(); ++g) {
            const HullFacet& facet = hull_.facets[hull_.groups[g]];
            const FilteredPlane filtered(corner(facet, 0), corner(facet, 1), corner(facet, 2));
            for (const std::uint32_t i : doubtful) {
                if (filtered.side(input_[i]) > 0) return at("outside:", i);
            }
        }
        return hull_.dimension == 2 ? polygon_flaw() : std::string();
    }

    /// The input points that are not in a ball around the corners' mean which no plane
    /// cuts; 2^-30 of the radius is more than all roundings.
    [[nodiscard]] std::vector<std::uint32_t> outside_inner_ball() const {
        Double3 centre = {};
        for (const Double3& p : hull_.points) {
            centre.x += p.x / static_cast<double>(hull_.points.size());
            centre.y += p.y / static_cast<double>(hull_.points.size());
            centre.z += p.z / static_cast<double>(hull_.points.size());
        }
        double radius = std::numeric_limits<double>::infinity();
        for (std::size_t g = 0; g + 1 < hull_.groups.size(); ++g) {
            const HullFacet& facet = hull_.facets[hull_.groups[g]];
            radius = std::min(
                radius,
                FilteredPlane(corner(facet, 0), corner(facet, 1), corner(facet, 2)).depth(centre));
        }
        std::vector<std::uint32_t> outside;
        for (std::uint32_t i = 0; i < input_.size(); ++i) {
            const Double3& p = input_[i];
            const double away = std::hypot(p.x - centre.x, p.y - centre.y, p.z - centre.z);
            if (!(away < radius * (1 - 0x1p-30))) outside.push_back(i);
        }
        return outside;
    }

    /// A polygon's input points lie left of every border edge of the first side.
    [[nodiscard]] std::string polygon_flaw() const {
        for (const auto& [edge, f] : facet_left_) {
            const std::size_t other = facet_left_.at({edge[1], edge[0]});
            if (group_of_[f] == group_of_[other]) continue;
            const ExactVector normal = plane(hull_.facets[f]).normal;
            const Double3& a = hull_.points[edge[0]];
            const ExactVector inwards =
                exact_cross(normal, exact_difference(hull_.points[edge[1]], a));
            for (std::size_t i = 0; i < input_.size(); ++i) {
                if (exact_dot(inwards, exact_difference(input_[i], a)).sign() < 0) {
                    return at("outside the polygon:", i);
                }
            }
        }
        return {};
    }

    std::span<const Double3> input_;
    const convex::ConvexHull& hull_;
    std::vector<std::size_t> group_of_;
    std::map<std::array<std::uint32_t, 2>, std::size_t> facet_left_;
};

inline std::string hull_flaw(std::span<const Double3> input, const convex::ConvexHull& hull) {
    return HullJudge(input, hull).flaw();
}

}  // namespace cdprep::test
