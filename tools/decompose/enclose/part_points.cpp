// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/part_points.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>

#include "cdprep/exact/predicates.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

constexpr std::uint32_t kNoPart = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kFew = 8;  ///< points: no selection needed

/// Returns the directions from a cube's centre to the points of a grid on its faces.
std::vector<Double3> make_directions() {
    std::vector<Double3> directions;
    for (int x = -2; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y) {
            for (int z = -2; z <= 2; ++z) {
                if (std::max({std::abs(x), std::abs(y), std::abs(z)}) < 2) continue;
                directions.push_back(
                    {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
            }
        }
    }
    return directions;
}

std::vector<std::uint32_t> places_of(const SolidCells& cells, const SolidCell& cell) {
    std::vector<std::uint32_t> places;
    for (const std::uint32_t fragment : cell.fragments) {
        const auto& of_fragment = cells.fragments[fragment].place;
        places.insert(places.end(), of_fragment.begin(), of_fragment.end());
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
}

/// Returns, for each cell, the largest part that contains it.
std::vector<std::uint32_t> choose_owners(std::size_t cell_count,
                                         std::span<const std::vector<std::uint32_t>> parts) {
    std::vector<std::uint32_t> order(parts.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return parts[a].size() > parts[b].size();
    });
    std::vector<std::uint32_t> owner(cell_count, kNoPart);
    for (const std::uint32_t part : order) {
        for (const std::uint32_t cell : parts[part]) {
            if (owner[cell] == kNoPart) owner[cell] = part;
        }
    }
    return owner;
}

/// Returns true if p lies in the polygon. All facets are in one plane and viewed along each axis.
bool is_within_polygon(const ConvexHull& hull, const Double3& p) {
    for (const auto& f : hull.facets) {
        const Double3 &a = hull.points[f[0]], &b = hull.points[f[1]], &c = hull.points[f[2]];
        if (exact::orient3d(a, b, c, p) != 0) return false;
    }
    for (const auto& f : hull.facets) {
        const Double3 &a = hull.points[f[0]], &b = hull.points[f[1]], &c = hull.points[f[2]];
        bool within = true;
        for (const auto& [x, y] :
             {std::pair(&Double3::x, &Double3::y), std::pair(&Double3::y, &Double3::z),
              std::pair(&Double3::z, &Double3::x)}) {
            const Double2 pa = {a.*x, a.*y}, pb = {b.*x, b.*y}, pc = {c.*x, c.*y},
                          pp = {p.*x, p.*y};
            const int s = exact::orient2d(pa, pb, pp);
            const int t = exact::orient2d(pb, pc, pp);
            const int u = exact::orient2d(pc, pa, pp);
            const bool mixed = std::min({s, t, u}) < 0 && std::max({s, t, u}) > 0;
            within = within && !mixed;
        }
        if (within) return true;
    }
    return false;
}

/// Points in boxes within boxes. If all corners of a box are behind a facet, so are its points.
/// This is exact, because the coordinates of boxes are those of points.
class InsideProof {
public:
    InsideProof(const ConvexHull& hull, std::span<const Double3> points)
        : points_(points.begin(), points.end()) {
        facets_.reserve(hull.facets.size());
        for (const auto& f : hull.facets) {
            facets_.push_back({hull.points[f[0]], hull.points[f[1]], hull.points[f[2]]});
        }
    }

    EnclosureProof run() {
        std::vector<std::uint32_t> all(facets_.size());
        std::iota(all.begin(), all.end(), 0U);
        look(points_, all);
        return proof_;
    }

private:
    void look(std::span<Double3> points, std::span<const std::uint32_t> facets) {
        if (points.size() <= kFew) {
            for (const Double3& p : points) proof_.outside += is_behind_all(p, facets) ? 0 : 1;
            return;
        }
        mesh::Box box;
        for (const Double3& p : points) box.add(p);
        std::vector<std::uint32_t> near;
        for (const std::uint32_t facet : facets) {
            if (!is_behind(box, facets_[facet])) near.push_back(facet);
        }
        if (near.empty()) return;
        const Double3 size = {box.upper.x - box.lower.x, box.upper.y - box.lower.y,
                              box.upper.z - box.lower.z};
        double Double3::*axis = &Double3::z;
        if (size.y >= size.z) axis = &Double3::y;
        if (size.x >= size.y && size.x >= size.z) axis = &Double3::x;
        const std::size_t half = points.size() / 2;
        // Ties are broken by all coordinates: every standard library selects the same halves.
        std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half),
                         points.end(), [&](const Double3& a, const Double3& b) {
                             return std::tie(a.*axis, a.x, a.y, a.z) <
                                    std::tie(b.*axis, b.x, b.y, b.z);
                         });
        look(points.first(half), near);
        look(points.subspan(half), near);
    }

    bool is_behind_all(const Double3& p, std::span<const std::uint32_t> facets) {
        for (const std::uint32_t facet : facets) {
            const Corners& t = facets_[facet];
            ++proof_.tests;
            if (exact::orient3d(t[0], t[1], t[2], p) < 0) return false;
        }
        return true;
    }

    bool is_behind(const mesh::Box& box, const Corners& facet) {
        const auto& [low, high] = box;
        const std::array<Corners, 3> corners = {
            {{low, high, {low.x, low.y, high.z}},
             {{{low.x, high.y, low.z}, {low.x, high.y, high.z}, {high.x, low.y, low.z}}},
             {{{high.x, low.y, high.z}, {high.x, high.y, low.z}, high}}}};
        for (const Corners& three : corners) {
            proof_.tests += 3;
            for (const int sign : exact::plane_signs(facet, three)) {
                if (sign < 0) return false;
            }
        }
        return true;
    }

    std::vector<Double3> points_;
    std::vector<Corners> facets_;
    EnclosureProof proof_;
};

}  // namespace

void add_corners(const Place& place, std::vector<Double3>& points) {
    for (unsigned k = 0; k < 8; ++k) {
        const bool is_new = ((k & 1U) == 0 || place.upper.x != place.lower.x) &&
                            ((k & 2U) == 0 || place.upper.y != place.lower.y) &&
                            ((k & 4U) == 0 || place.upper.z != place.lower.z);
        if (!is_new) continue;
        points.push_back({(k & 1U) == 0 ? place.lower.x : place.upper.x,
                          (k & 2U) == 0 ? place.lower.y : place.upper.y,
                          (k & 4U) == 0 ? place.lower.z : place.upper.z});
    }
}

std::vector<Double3> extreme_points(const SolidCells& cells, const SolidCell& cell) {
    static const std::vector<Double3> kDirections = make_directions();
    std::vector<Double3> points = cell.corners;
    for (const std::uint32_t place : places_of(cells, cell)) {
        points.push_back(cells.places[place].lower);
    }
    if (points.size() <= kFew) return points;
    std::vector<std::size_t> chosen;
    for (const Double3& direction : kDirections) {
        std::size_t best = 0;
        double most = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double value = mesh::dot(direction, points[i]);
            if (value <= most) continue;
            most = value;
            best = i;
        }
        chosen.push_back(best);
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    std::vector<Double3> extreme;
    extreme.reserve(chosen.size());
    for (const std::size_t i : chosen) extreme.push_back(points[i]);
    return extreme;
}

std::vector<PartPoints> gather_points(const SolidCells& cells, const mesh::Mesh& mesh,
                                      std::span<const std::vector<std::uint32_t>> parts) {
    const std::vector<std::uint32_t> owner = choose_owners(cells.cells.size(), parts);
    std::vector<std::vector<std::uint32_t>> fragments(parts.size());
    std::vector<PartPoints> gathered(parts.size());
    for (std::uint32_t i = 0; i < cells.cells.size(); ++i) {
        if (owner[i] == kNoPart) continue;
        const SolidCell& cell = cells.cells[i];
        auto& list = fragments[owner[i]];
        list.insert(list.end(), cell.fragments.begin(), cell.fragments.end());
        auto& points = gathered[owner[i]].points;
        points.insert(points.end(), cell.corners.begin(), cell.corners.end());
    }
    std::vector<bool> is_held(cells.fragments.size(), false);
    std::vector<std::uint32_t> count(cells.fragment_count.size(), 0);
    for (std::size_t part = 0; part < parts.size(); ++part) {
        auto& list = fragments[part];
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        PartPoints& of = gathered[part];
        for (const std::uint32_t fragment : list) ++count[cells.fragments[fragment].triangle];
        std::vector<std::uint32_t> places;
        for (const std::uint32_t fragment : list) {
            const Fragment& f = cells.fragments[fragment];
            const bool is_whole = count[f.triangle] == cells.fragment_count[f.triangle];
            const auto& corners = is_whole ? mesh.triangles[f.triangle].vertex : f.place;
            places.insert(places.end(), corners.begin(), corners.end());
            of.triangles.push_back(f.triangle);
            if (!is_held[fragment]) ++of.fragments;
            is_held[fragment] = true;
        }
        for (const std::uint32_t fragment : list) count[cells.fragments[fragment].triangle] = 0;
        std::sort(places.begin(), places.end());
        places.erase(std::unique(places.begin(), places.end()), places.end());
        for (const std::uint32_t place : places) add_corners(cells.places[place], of.points);
        std::sort(of.triangles.begin(), of.triangles.end());
        of.triangles.erase(std::unique(of.triangles.begin(), of.triangles.end()),
                           of.triangles.end());
    }
    return gathered;
}

EnclosureProof prove_points(const ConvexHull& hull, std::span<const Double3> points) {
    if (hull.dimension == 3) return InsideProof(hull, points).run();
    EnclosureProof proof;
    for (const Double3& p : points) {
        const bool within = hull.dimension == 2 ? is_within_polygon(hull, p)
                                                : std::find(hull.points.begin(), hull.points.end(),
                                                            p) != hull.points.end();
        proof.outside += within ? 0 : 1;
    }
    return proof;
}

}  // namespace cdprep::convex
