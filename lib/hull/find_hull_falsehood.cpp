// SPDX-License-Identifier: MIT
#include "cdprep/advanced/find_falsehood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/hulls.h"
#include "exact/predicates.h"
#include "hull/hull_points.h"

namespace cdprep {
namespace {

using format::Hull;
using format::HullFacet;
using Found = std::optional<format::Damage>;

std::vector<Double3> vertices_of(const Model& model) {
    std::vector<Double3> vertices(model.mesh().positions_f64.begin(),
                                  model.mesh().positions_f64.end());
    for (const Float3& p : model.mesh().positions_f32) vertices.push_back({p.x, p.y, p.z});
    return vertices;
}

/// Returns pairs of source number and vertex, sorted by source number.
std::vector<std::array<std::uint32_t, 2>> by_source(const Model& model) {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    const auto source = model.source().vertex;
    for (std::uint32_t v = 0; v < source.size(); ++v) pairs.push_back({source[v], v});
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

bool equal(const Double3& a, const Double3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Discards points that are certainly behind a facet's plane. Almost all are far behind.
class FarBehind {
public:
    FarBehind(const Double3& a, const Double3& b, const Double3& c) : at_(a) {
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        normal_ = {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
        size_ = {std::fabs(uy * vz) + std::fabs(uz * vy), std::fabs(uz * vx) + std::fabs(ux * vz),
                 std::fabs(ux * vy) + std::fabs(uy * vx)};
    }

    /// Returns true only for points that are behind. Heights are off by less than 2^-49 of the sum
    /// of their terms' sizes, plus underflow: 2^-1074 per product, times a difference or alone.
    [[nodiscard]] bool operator()(const Double3& p) const {
        constexpr double kDoubt = 0x1p-48, kUnderflow = 1e-300;
        const double x = p.x - at_.x, y = p.y - at_.y, z = p.z - at_.z;
        const double height = normal_.x * x + normal_.y * y + normal_.z * z;
        const double ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
        const double most = size_.x * ax + size_.y * ay + size_.z * az;
        return height < -(kDoubt * most + kUnderflow * (ax + ay + az + 1));
    }

private:
    Double3 at_, normal_, size_;
};

class HullCheck {
public:
    HullCheck(std::span<const std::byte> file, const Model& model)
        : file_(file), model_(model), vertices_(vertices_of(model)), by_source_(by_source(model)) {}

    [[nodiscard]] Found find_falsehood(std::uint32_t number) const {
        const Hull& hull = model_.hulls().hulls[number];
        const ConvexPoints points = convex_points(model_, number);
        if (const Found damage = find_strange_point(hull, points)) return damage;
        if (const Found damage = find_bad_edge(hull, points)) return damage;
        if (const Found damage = find_bad_neighbour(hull, points)) return damage;
        return find_outside(number, hull, points);
    }

    /// Finds a vertex that no part contains, if there are parts. Exact.
    [[nodiscard]] Found find_left_out() const {
        const auto first = find_hull(model_, format::HullScope::part);
        if (!first) return std::nullopt;
        std::vector<ConvexPoints> parts;
        std::vector<Bounds> bounds;
        for (std::uint32_t i = *first; i < model_.hulls().hulls.size(); ++i) {
            if (model_.hulls().hulls[i].point_count == 0) continue;
            parts.push_back(convex_points(model_, i));
            bounds.push_back(bounds_of(parts.back()));
        }
        std::size_t last = 0;  // the next vertex is often in the same part
        for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
            const auto is_in = [&](std::size_t i) {
                return i < parts.size() && bounds[i].contains(vertices_[v]) &&
                       holds(parts[i], vertices_[v]);
            };
            if (is_in(last)) continue;
            last = 0;
            while (last < parts.size() && !is_in(last)) ++last;
            if (last == parts.size())
                return format::wrong_fact(file_, SectionId::hulls, *first, v, 0);
        }
        return std::nullopt;
    }

private:
    struct Bounds {
        Double3 lower, upper;
        [[nodiscard]] bool contains(const Double3& p) const {
            return lower.x <= p.x && p.x <= upper.x && lower.y <= p.y && p.y <= upper.y &&
                   lower.z <= p.z && p.z <= upper.z;
        }
    };

    static Bounds bounds_of(const ConvexPoints& points) {
        Bounds bounds = {hull_point(points, 0), hull_point(points, 0)};
        auto& [low, high] = bounds;
        for (std::uint32_t i = 1; i < points.count; ++i) {
            const Double3 p = hull_point(points, i);
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        return bounds;
    }

    static bool holds(const ConvexPoints& hull, const Double3& p) {
        format::HullBlock block;
        block.at[0].fill(p.x);
        block.at[1].fill(p.y);
        block.at[2].fill(p.z);
        ConvexPoints point;
        point.blocks = {&block, 1};
        point.count = 1;
        point.reach = {std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)};
        return convex_collide(hull, point, Placement::b_moves(Pose()));
    }

    [[nodiscard]] std::span<const HullFacet> facets(const Hull& hull) const {
        return model_.hulls().facets.subspan(hull.first_facet, hull.facet_count);
    }

    /// Finds a point of an exact hull that differs from the vertex it names.
    [[nodiscard]] Found find_strange_point(const Hull& hull, const ConvexPoints& points) const {
        if ((hull.flags & format::hull_exact) == 0 || by_source_.empty()) return std::nullopt;
        for (std::uint32_t p = 0; p < hull.point_count; ++p) {
            const std::size_t place = std::size_t{hull.first_block} * format::kHullLanes + p;
            const std::uint32_t source = model_.hulls().vertices[place];
            const auto at = std::lower_bound(by_source_.begin(), by_source_.end(),
                                             std::array<std::uint32_t, 2>{source, 0});
            const bool named = at != by_source_.end() && (*at)[0] == source &&
                               equal(vertices_[(*at)[1]], hull_point(points, p));
            if (!named)
                return format::wrong_fact(file_, SectionId::hull_vertices, place, source, 0);
        }
        return std::nullopt;
    }

    /// Finds an edge that is reflex, or flat between groups, or not flat within one.
    [[nodiscard]] Found find_bad_edge(const Hull& hull, const ConvexPoints& points) const {
        const auto all = facets(hull);
        for (std::uint32_t f = 0; f < all.size(); ++f) {
            const HullFacet& facet = all[f];
            const auto& point = facet.point;
            for (std::size_t i = 0; i < 3; ++i) {
                const HullFacet& other = all[facet.across[i]];
                const auto far = std::find_if(
                    other.point.begin(), other.point.end(),
                    [&](std::uint32_t p) { return p != point[i] && p != point[(i + 1) % 3]; });
                const int sign =
                    orient3d(hull_point(points, point[0]), hull_point(points, point[1]),
                             hull_point(points, point[2]), hull_point(points, *far));
                const bool flat = facet.group == other.group || hull.dimension == 2;
                if (flat ? sign == 0 : sign > 0) continue;
                return format::wrong_fact(file_, SectionId::hull_facets, hull.first_facet + f,
                                          facet.across[i], f);
            }
        }
        return std::nullopt;
    }

    /// Finds a difference between the neighbours and the ends of the facets' edges.
    [[nodiscard]] Found find_bad_neighbour(const Hull& hull, const ConvexPoints& points) const {
        if (points.neighbours.empty()) return std::nullopt;
        std::vector<std::array<std::uint32_t, 2>> edges;
        for (const HullFacet& facet : facets(hull)) {
            for (std::size_t i = 0; i < 3; ++i) {
                edges.push_back({facet.point[i], facet.point[(i + 1) % 3]});
            }
        }
        std::sort(edges.begin(), edges.end());
        std::vector<std::array<std::uint32_t, 2>> stored;
        for (std::uint32_t p = 0; p < hull.point_count; ++p) {
            const std::uint32_t end = points.neighbour_begins[p + 1];
            for (std::uint32_t i = points.neighbour_begins[p]; i < end; ++i) {
                stored.push_back({p, points.neighbours[i]});
            }
        }
        std::sort(stored.begin(), stored.end());
        if (edges == stored) return std::nullopt;
        return format::wrong_fact(file_, SectionId::hull_neighbours, hull.first_neighbour,
                                  stored.size(), edges.size());
    }

    /// Returns the points that must not be outside: all vertices for the whole model's hull,
    /// otherwise the hull's own points.
    [[nodiscard]] std::vector<Double3> contained(const Hull& hull,
                                                 const ConvexPoints& points) const {
        if (hull.scope == format::HullScope::whole) return vertices_;
        std::vector<Double3> own;
        for (std::uint32_t p = 0; p < hull.point_count; ++p) own.push_back(hull_point(points, p));
        return own;
    }

    /// Finds a point in front of a facet. For a hull of one point, finds a different point.
    [[nodiscard]] Found find_outside(std::uint32_t number, const Hull& hull,
                                     const ConvexPoints& points) const {
        const std::vector<Double3> inside = contained(hull, points);
        for (std::uint32_t g = 0; g < hull.group_count; ++g) {
            const std::uint32_t first =
                model_.hulls().groups[std::size_t{hull.first_group} + g].first_facet;
            const auto& point = facets(hull)[first].point;
            const Double3 a = hull_point(points, point[0]), b = hull_point(points, point[1]),
                          c = hull_point(points, point[2]);
            const FarBehind far_behind(a, b, c);
            for (const Double3& p : inside) {
                if (!far_behind(p) && orient3d(a, b, c, p) < 0) {
                    return format::wrong_fact(file_, SectionId::hulls, number, g, hull.group_count);
                }
            }
        }
        if (hull.dimension > 0 || inside.empty()) return std::nullopt;
        const bool all =
            hull.dimension == 0 && std::all_of(inside.begin(), inside.end(), [&](const Double3& p) {
                return equal(p, hull_point(points, 0));
            });
        return all ? Found{} : format::wrong_fact(file_, SectionId::hulls, number, 0, 0);
    }

    std::span<const std::byte> file_;
    const Model& model_;
    std::vector<Double3> vertices_;
    std::vector<std::array<std::uint32_t, 2>> by_source_;
};

}  // namespace

std::optional<format::Damage> find_hull_falsehood(std::span<const std::byte> file,
                                                  const Model& model) {
    if (model.hulls().hulls.empty() || !model.serves(Ask::hulls)) return std::nullopt;
    const format::FloatEnvironment environment;
    const HullCheck check(file, model);
    for (std::uint32_t i = 0; i < model.hulls().hulls.size(); ++i) {
        if (const Found damage = check.find_falsehood(i)) return damage;
    }
    return check.find_left_out();
}

}  // namespace cdprep
