// SPDX-License-Identifier: GPL-3.0-or-later
#include "info/find_cover_falsehood.h"

#include <CGAL/Lazy_exact_nt.h>
#include <CGAL/gmpxx.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "cdprep/hulls.h"
#include "mesh/point_tree.h"
#include "mesh/vectors.h"

// A triangle is cut in its own coordinates: a point is a weighted sum of the corners, up to a
// common factor. The height of a point above a plane is linear in the weights. So a plane becomes a
// line, given by the heights of the three corners. Two lines meet at their cross product. Each
// corner of the remaining polygon is where two such lines meet, however often it was cut. So
// numbers do not grow.

namespace cdprep::convex {
namespace {

using mesh::cross;
using mesh::dot;
using mesh::minus;

// CGAL's Exact_rational is the same class, in a header that takes twice as long to compile.
using Number = CGAL::Lazy_exact_nt<mpq_class>;
using Row = std::array<Number, 3>;

constexpr std::array<double Double3::*, 3> kAxes = {&Double3::x, &Double3::y, &Double3::z};

Row exact(const Double3& p) {
    return {Number(p.x), Number(p.y), Number(p.z)};
}

/// Returns the side of a line on which a point lies: 1 is beyond it.
int side(const Row& line, const Row& point) {
    return static_cast<int>(CGAL::sign(dot(line, point)));
}

/// Returns the point where two lines meet, scaled so that the sum of its weights is positive.
Row meet(const Row& a, const Row& b) {
    Row point = cross(a, b);
    if (CGAL::sign(point[0] + point[1] + point[2]) < 0) {
        for (Number& weight : point) weight = -weight;
    }
    return point;
}

/// A corner of a convex polygon in the triangle, and the line from it to the next corner.
struct PolygonCorner {
    Row point;
    Row line;
};
using Polygon = std::vector<PolygonCorner>;

/// Returns the part of a polygon beyond a line (`wanted` 1) or before it (-1). `sides` are those
/// of the corners. Some of the polygon's interior must lie on the wanted side.
Polygon cut(const Polygon& polygon, const Row& line, const std::vector<int>& sides, int wanted) {
    Polygon part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const int here = wanted * sides[i];
        const int next = wanted * sides[(i + 1) % polygon.size()];
        if (here >= 0) {
            part.push_back({polygon[i].point, here == 0 && next < 0 ? line : polygon[i].line});
        }
        if (here * next >= 0) continue;
        part.push_back({meet(polygon[i].line, line), next < 0 ? line : polygon[i].line});
    }
    return part;
}

/// A part in the form that the check uses.
struct Part {
    ConvexPoints points;
    std::span<const format::HullFacet> facets;
    std::int32_t dimension;
    mesh::Box box;
};

/// The lines along which a part's boundary planes cut a triangle; empty if it contains all of it.
using Lines = std::vector<Row>;

class CoverCheck {
public:
    explicit CoverCheck(const Model& model, std::uint32_t first) : model_(model) {
        for (std::uint32_t i = first; i < model.hulls().hulls.size(); ++i) {
            const format::Hull& hull = model.hulls().hulls[i];
            if (hull.dimension < 2) continue;
            Part part{convex_points(model, i),
                      model.hulls().facets.subspan(hull.first_facet, hull.facet_count),
                      hull.dimension,
                      {}};
            for (std::uint32_t p = 0; p < part.points.count; ++p) {
                part.box.add(part.points.point(p));
            }
            parts_.push_back(part);
        }
    }

    [[nodiscard]] bool is_covered(const format::Triangle& triangle) {
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = position(triangle.vertex[k]);
        if (exact::is_degenerate(corners)) return true;
        // Consecutive triangles often lie in the same part.
        if (last_ < parts_.size()) {
            const auto lines = lines_of(parts_[last_], corners);
            if (lines && lines->empty()) return true;
        }
        mesh::Box box;
        for (const Double3& p : corners) box.add(p);
        std::vector<Lines> cutting;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            if (!parts_[i].box.meets(box)) continue;
            auto lines = lines_of(parts_[i], corners);
            if (!lines) continue;
            if (lines->empty()) {
                last_ = i;
                return true;
            }
            cutting.push_back(std::move(*lines));
        }
        const Number none(0), all(1);
        return is_covered({{{all, none, none}, {none, none, all}},
                           {{none, all, none}, {all, none, none}},
                           {{none, none, all}, {none, all, none}}},
                          cutting);
    }

private:
    [[nodiscard]] Double3 position(std::uint32_t vertex) const {
        if (!model_.mesh().positions_f64.empty()) return model_.mesh().positions_f64[vertex];
        const Float3& p = model_.mesh().positions_f32[vertex];
        return {p.x, p.y, p.z};
    }

    /// Returns nothing if the part contains at most some of the triangle's border.
    [[nodiscard]] static std::optional<Lines> lines_of(const Part& part, const Corners& corners) {
        return part.dimension == 3 ? lines_of_body(part, corners) : lines_of_sheet(part, corners);
    }

    static std::optional<Lines> lines_of_body(const Part& part, const Corners& corners) {
        std::vector<const format::HullFacet*> crossing;
        for (const format::HullFacet& facet : part.facets) {
            const auto signs = exact::plane_signs(plane_of(part, facet), corners);
            const auto [least, most] = std::minmax_element(signs.begin(), signs.end());
            if (*least >= 0) continue;
            if (*most <= 0) return std::nullopt;
            crossing.push_back(&facet);
        }
        Lines lines;
        for (const format::HullFacet* facet : crossing) {
            const Corners plane = plane_of(part, *facet);
            const Row at = exact(plane[0]);
            const Row normal = cross(minus(exact(plane[1]), at), minus(exact(plane[2]), at));
            Row line;
            for (std::size_t k = 0; k < 3; ++k) line[k] = dot(normal, minus(exact(corners[k]), at));
            lines.push_back(std::move(line));
        }
        return lines;
    }

    /// Returns the lines for a part that is a polygon, from its edges. Projects along an axis such
    /// that the polygon keeps an area.
    static std::optional<Lines> lines_of_sheet(const Part& part, const Corners& corners) {
        const Corners plane = plane_of(part, part.facets.front());
        for (const int sign : exact::plane_signs(plane, corners)) {
            if (sign != 0) return std::nullopt;
        }
        double Double3::*x = nullptr;
        double Double3::*y = nullptr;
        const auto flat = [&](const Double3& p) { return Double2{p.*x, p.*y}; };
        int turn = 0;
        for (std::size_t k = 0; k < 3 && turn == 0; ++k) {
            x = kAxes[k];
            y = kAxes[(k + 1) % 3];
            turn = exact::orient2d(flat(plane[0]), flat(plane[1]), flat(plane[2]));
        }
        const std::uint32_t front = part.facets.front().group;
        Lines lines;
        for (const format::HullFacet& facet : part.facets) {
            for (std::size_t i = 0; i < 3 && facet.group == front; ++i) {
                if (part.facets[facet.across[i]].group == front) continue;
                const Double3 from = part.points.point(facet.point[i]);
                const Double3 to = part.points.point(facet.point[(i + 1) % 3]);
                std::array<int, 3> signs;
                for (std::size_t k = 0; k < 3; ++k) {
                    signs[k] = turn * exact::orient2d(flat(from), flat(to), flat(corners[k]));
                }
                const auto [least, most] = std::minmax_element(signs.begin(), signs.end());
                if (*least >= 0) continue;
                if (*most <= 0) return std::nullopt;
                Row line;
                const Number dx = Number(to.*x) - Number(from.*x);
                const Number dy = Number(to.*y) - Number(from.*y);
                for (std::size_t k = 0; k < 3; ++k) {
                    line[k] = Number(turn) * (dy * (Number(corners[k].*x) - Number(from.*x)) -
                                              dx * (Number(corners[k].*y) - Number(from.*y)));
                }
                lines.push_back(std::move(line));
            }
        }
        return lines;
    }

    static Corners plane_of(const Part& part, const format::HullFacet& facet) {
        return {part.points.point(facet.point[0]), part.points.point(facet.point[1]),
                part.points.point(facet.point[2])};
    }

    /// Returns whether the parts together contain the polygon. Each line of the first part cuts off
    /// the portion beyond it. The other parts must contain these portions.
    static bool is_covered(const Polygon& polygon, std::span<const Lines> parts) {
        if (parts.empty()) return false;
        Polygon rest = polygon;
        std::vector<Polygon> beyond;
        std::vector<int> sides;
        for (const Row& line : parts.front()) {
            sides.clear();
            for (const PolygonCorner& corner : rest) sides.push_back(side(line, corner.point));
            const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
            if (*most <= 0) continue;
            if (*least >= 0) return is_covered(polygon, parts.subspan(1));
            beyond.push_back(cut(rest, line, sides, 1));
            rest = cut(rest, line, sides, -1);
        }
        return std::all_of(beyond.begin(), beyond.end(),
                           [&](const Polygon& left) { return is_covered(left, parts.subspan(1)); });
    }

    const Model& model_;
    std::vector<Part> parts_;
    std::size_t last_ = 0;  ///< the last part that contained a whole triangle
};

}  // namespace

std::optional<format::Damage> find_cover_falsehood(std::span<const std::byte> file,
                                                   const Model& model) {
    if (!model.serves(Ask::hulls)) return std::nullopt;
    const auto first = find_hull(model, format::HullScope::part);
    if (!first) return std::nullopt;
    CoverCheck check(model, *first);
    for (std::uint32_t i = 0; i < model.mesh().triangles.size(); ++i) {
        if (check.is_covered(model.mesh().triangles[i])) continue;
        return format::wrong_fact(file, format::SectionId::hulls, *first, i, 0);
    }
    return std::nullopt;
}

}  // namespace cdprep::convex
