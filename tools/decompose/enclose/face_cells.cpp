// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/face_cells.h"

#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "decompose/enclose/flush_bound.h"
#include "decompose/enclose/plane.h"
#include "decompose/surface/surface_edges.h"
#include "hull/convex_hull.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using Interval = CGAL::Interval_nt<true>;
using mesh::Box;
using mesh::HalfEdge;

// Limits of the work, as the header states them.
constexpr std::size_t kMostTriangles = 4'000;
constexpr std::size_t kMostPlanes = 32;
constexpr std::size_t kMostCells = 128;
constexpr double kFlat = 1e-6;       ///< of the diagonal: vertices this near a plane are on it
constexpr double kStep = 8;          ///< in kFlat: the step to a point beside a plane
constexpr double kInwards = 1e-3;    ///< of the way to a cell's middle: the step from a corner
constexpr double kParallel = 1e-9;   ///< 1 - the cosine between normals of one plane
constexpr double kAlongAxis = 1e-9;  ///< 1 - a component of a normal that counts as an axis

/// Connected triangles in one plane.
struct Face {
    Plane plane;
    std::vector<std::uint32_t> vertices;
    bool has_reflex_edge = false;
};

/// A corner of a convex region, and the planes in which it lies. Two corners with two common planes
/// are the ends of an edge, or lie on a common line.
struct RegionCorner {
    std::uint32_t place;
    std::vector<std::uint32_t> planes;
};

struct Region {
    std::uint32_t body;
    std::vector<RegionCorner> corners;
    std::vector<std::uint32_t> fragments;
};

Double3 middle(const Place& place) {
    return {place.lower.x / 2 + place.upper.x / 2, place.lower.y / 2 + place.upper.y / 2,
            place.lower.z / 2 + place.upper.z / 2};
}

class FaceCutter {
public:
    FaceCutter(const mesh::Mesh& mesh, const Solid& solid, const std::vector<bool>& is_wanted)
        : mesh_(mesh), solid_(solid), is_wanted_(is_wanted), near_(kFlat * solid.diagonal()) {}

    std::optional<SolidCells> run() {
        if (!sort_triangles()) return std::nullopt;
        edges_ = find_surface_edges(mesh_, serial_for);
        for (const Double3& p : mesh_.positions) cells_.places.push_back({p, p});
        cells_.fragment_count.assign(mesh_.triangles.size(), 1);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            cells_.fragments.push_back({mesh_.triangles[i].vertex, i});
        }
        for (std::uint32_t body = 0; body < is_wanted_.size(); ++body) {
            if (is_wanted_[body] && !cut_body(body)) return std::nullopt;
        }
        return std::move(cells_);
    }

private:
    bool sort_triangles() {
        triangles_of_.resize(is_wanted_.size());
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            const std::uint32_t body = solid_.body_of(i);
            if (!is_wanted_[body]) continue;
            if (triangles_of_[body].size() == kMostTriangles) return false;
            triangles_of_[body].push_back(i);
        }
        return true;
    }

    bool cut_body(std::uint32_t body) {
        const auto faces = find_faces(body);
        if (!faces) return false;
        const std::vector<Plane> planes = choose_planes(*faces);
        if (planes.size() > kMostPlanes) return false;
        std::vector<Region> regions = {region_around(body)};
        for (const Plane& plane : planes) {
            std::vector<Region> next;
            met_.clear();
            for (Region& region : regions) cut(std::move(region), plane, next);
            ++plane_number_;
            regions = std::move(next);
            if (cells_.cells.size() + regions.size() > kMostCells) return false;
        }
        return std::all_of(regions.begin(), regions.end(),
                           [this](const Region& region) { return close(region); });
    }

    [[nodiscard]] const Double3& position(std::uint32_t vertex) const {
        return mesh_.positions[vertex];
    }

    /// Starts each face at the largest triangle left, and adds the connected triangles in its
    /// plane. Returns nothing if an edge of the surface is a barrier.
    [[nodiscard]] std::optional<std::vector<Face>> find_faces(std::uint32_t body) const {
        const auto& own = triangles_of_[body];
        std::vector<std::pair<double, std::uint32_t>> order;
        for (const std::uint32_t t : own) {
            for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
                if (is_barrier(edges_.kind[h])) return std::nullopt;
            }
            const auto& v = mesh_.triangles[t].vertex;
            const Double3 n = mesh::cross(mesh::minus(position(v[1]), position(v[0])),
                                          mesh::minus(position(v[2]), position(v[0])));
            order.emplace_back(-mesh::dot(n, n), t);
        }
        std::sort(order.begin(), order.end());
        std::map<std::uint32_t, std::uint32_t> face_of;
        std::vector<Face> faces;
        for (const auto& [area, seed] : order) {
            if (face_of.contains(seed)) continue;
            if (area == 0) return std::nullopt;
            faces.push_back({plane_of(seed), {}, false});
            flood(seed, static_cast<std::uint32_t>(faces.size() - 1), faces.back(), face_of);
        }
        for (const auto& [t, face] : face_of) {
            for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
                if (edges_.kind[h] != EdgeKind::reflex) continue;
                const std::uint32_t other = face_of.at(edges_.twin[h] / 3);
                if (other == face) continue;
                const Double3& apex =
                    position(mesh::apex_of(std::span(mesh_.triangles), edges_.twin[h]));
                if (height(faces[face].plane, apex) <= near_) continue;
                faces[face].has_reflex_edge = faces[other].has_reflex_edge = true;
            }
        }
        return faces;
    }

    /// Returns the plane of a triangle. A normal almost along an axis becomes that axis exactly,
    /// because its cuts are exact then.
    [[nodiscard]] Plane plane_of(std::uint32_t triangle) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        const Double3& a = position(v[0]);
        Double3 n = mesh::cross(mesh::minus(position(v[1]), a), mesh::minus(position(v[2]), a));
        const double length = std::sqrt(mesh::dot(n, n));
        n = {n.x / length, n.y / length, n.z / length};
        for (double Double3::*axis : {&Double3::x, &Double3::y, &Double3::z}) {
            if (std::fabs(n.*axis) < 1 - kAlongAxis) continue;
            Double3 exact = {0, 0, 0};
            exact.*axis = n.*axis > 0 ? 1 : -1;
            n = exact;
        }
        return {n, mesh::dot(n, a)};
    }

    void flood(std::uint32_t seed, std::uint32_t number, Face& face,
               std::map<std::uint32_t, std::uint32_t>& face_of) const {
        std::vector<std::uint32_t> stack = {seed};
        face_of[seed] = number;
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            const auto& v = mesh_.triangles[t].vertex;
            face.vertices.insert(face.vertices.end(), v.begin(), v.end());
            for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
                const std::uint32_t other = edges_.twin[h] / 3;
                if (face_of.contains(other) || !is_in(face.plane, other)) continue;
                face_of[other] = number;
                stack.push_back(other);
            }
        }
    }

    [[nodiscard]] bool is_in(const Plane& plane, std::uint32_t triangle) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        const Double3 n = mesh::cross(mesh::minus(position(v[1]), position(v[0])),
                                      mesh::minus(position(v[2]), position(v[0])));
        return mesh::dot(n, plane.normal) > 0 && std::all_of(v.begin(), v.end(), [&](auto vertex) {
                   return std::fabs(height(plane, position(vertex))) <= near_;
               });
    }

    /// Returns the planes of faces with reflex edges, each once.
    [[nodiscard]] std::vector<Plane> choose_planes(const std::vector<Face>& faces) const {
        std::vector<Plane> chosen;
        for (const Face& face : faces) {
            if (!face.has_reflex_edge) continue;
            const bool is_known = std::any_of(chosen.begin(), chosen.end(), [&](const Plane& p) {
                return std::fabs(mesh::dot(p.normal, face.plane.normal)) > 1 - kParallel &&
                       std::all_of(face.vertices.begin(), face.vertices.end(), [&](auto vertex) {
                           return std::fabs(height(p, position(vertex))) <= near_;
                       });
            });
            if (!is_known) chosen.push_back(face.plane);
            if (chosen.size() > kMostPlanes) break;
        }
        return chosen;
    }

    Region region_around(std::uint32_t body) {
        Region region{body, {}, triangles_of_[body]};
        Box box;
        for (const std::uint32_t t : triangles_of_[body]) {
            for (const std::uint32_t v : mesh_.triangles[t].vertex) box.add(position(v));
        }
        for (unsigned k = 0; k < 8; ++k) {
            const std::array<unsigned, 3> side = {k & 1U, (k >> 1U) & 1U, (k >> 2U) & 1U};
            const Double3 corner = {side[0] == 0 ? box.lower.x : box.upper.x,
                                    side[1] == 0 ? box.lower.y : box.upper.y,
                                    side[2] == 0 ? box.lower.z : box.upper.z};
            region.corners.push_back(
                {add_place({corner, corner}), {side[0], 2 + side[1], 4 + side[2]}});
        }
        plane_number_ = 6;
        return region;
    }

    std::uint32_t add_place(const Place& place) {
        cells_.places.push_back(place);
        return static_cast<std::uint32_t>(cells_.places.size() - 1);
    }

    static Interval exact_height(const Plane& plane, const Place& place) {
        const Interval x(place.lower.x, place.upper.x);
        const Interval y(place.lower.y, place.upper.y);
        const Interval z(place.lower.z, place.upper.z);
        return plane.normal.x * x + plane.normal.y * y + plane.normal.z * z - plane.offset;
    }

    /// Returns -1 below the plane, 0 on it or near it, 1 above.
    [[nodiscard]] int side_of(const Plane& plane, std::uint32_t place) const {
        const Interval at = exact_height(plane, cells_.places[place]);
        return at.sup() < -near_ ? -1 : at.inf() > near_ ? 1 : 0;
    }

    /// Returns the place where the segment between two places on either side meets a plane.
    std::uint32_t cut_segment(std::uint32_t from, std::uint32_t to, const Plane& plane) {
        const auto key = std::minmax(from, to);
        const auto known = met_.find(key);
        if (known != met_.end()) return known->second;
        const Place a = cells_.places[key.first];
        const Place b = cells_.places[key.second];
        const Interval start = exact_height(plane, a);
        const Interval share = start / (start - exact_height(plane, b));
        Place cut;
        for (double Double3::*axis : {&Double3::x, &Double3::y, &Double3::z}) {
            const Interval begin(a.lower.*axis, a.upper.*axis);
            const Interval end(b.lower.*axis, b.upper.*axis);
            const Interval at = begin + share * (end - begin);
            // The segment does not leave the box of its ends, whatever the rounding.
            cut.lower.*axis = std::max(at.inf(), std::min(begin.inf(), end.inf()));
            cut.upper.*axis = std::min(at.sup(), std::max(begin.sup(), end.sup()));
            // For a plane across an axis, this coordinate is exact.
            if (std::fabs(plane.normal.*axis) == 1) {
                cut.lower.*axis = cut.upper.*axis = plane.offset * plane.normal.*axis;
            }
        }
        return met_[key] = add_place(cut);
    }

    void cut(Region region, const Plane& plane, std::vector<Region>& next) {
        Region low{region.body, {}, {}};
        Region high{region.body, {}, {}};
        std::vector<const RegionCorner*> below;
        std::vector<const RegionCorner*> above;
        for (RegionCorner& corner : region.corners) {
            const int side = side_of(plane, corner.place);
            if (side == 0) corner.planes.push_back(plane_number_);
            if (side <= 0) low.corners.push_back(corner);
            if (side >= 0) high.corners.push_back(corner);
            if (side < 0) below.push_back(&corner);
            if (side > 0) above.push_back(&corner);
        }
        if (below.empty() || above.empty()) {
            next.push_back(std::move(region));
            return;
        }
        for (const RegionCorner* a : below) {
            for (const RegionCorner* b : above) {
                RegionCorner corner{0, {}};
                std::set_intersection(a->planes.begin(), a->planes.end(), b->planes.begin(),
                                      b->planes.end(), std::back_inserter(corner.planes));
                if (corner.planes.size() < 2) continue;
                corner.planes.push_back(plane_number_);
                corner.place = cut_segment(a->place, b->place, plane);
                low.corners.push_back(corner);
                high.corners.push_back(std::move(corner));
            }
        }
        for (const std::uint32_t number : region.fragments) cut_fragment(number, plane, low, high);
        for (Region* half : {&low, &high}) {
            if (!half->fragments.empty() || is_in_body(centre(*half), half->body)) {
                next.push_back(std::move(*half));
            }
        }
    }

    void cut_fragment(std::uint32_t number, const Plane& plane, Region& low, Region& high) {
        const Fragment fragment = cells_.fragments[number];
        std::array<int, 3> side{};
        for (std::size_t k = 0; k < 3; ++k) side[k] = side_of(plane, fragment.place[k]);
        const auto [least, most] = std::minmax_element(side.begin(), side.end());
        if (*least == 0 && *most == 0) {
            (is_body_above(fragment, plane) ? high : low).fragments.push_back(number);
            return;
        }
        if (*most <= 0 || *least >= 0) {
            (*most <= 0 ? low : high).fragments.push_back(number);
            return;
        }
        std::array<std::vector<std::uint32_t>, 2> polygon;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t to = (k + 1) % 3;
            if (side[k] <= 0) polygon[0].push_back(fragment.place[k]);
            if (side[k] >= 0) polygon[1].push_back(fragment.place[k]);
            if (side[k] * side[to] >= 0) continue;
            const std::uint32_t met = cut_segment(fragment.place[k], fragment.place[to], plane);
            for (auto& of_side : polygon) of_side.push_back(met);
        }
        bool is_first = true;
        for (std::size_t which = 0; which < 2; ++which) {
            auto& fragments = (which == 0 ? low : high).fragments;
            for (std::size_t k = 2; k < polygon[which].size(); ++k) {
                const Fragment made = {
                    {polygon[which][0], polygon[which][k - 1], polygon[which][k]},
                    fragment.triangle};
                if (is_first) {
                    cells_.fragments[number] = made;
                    fragments.push_back(number);
                } else {
                    fragments.push_back(static_cast<std::uint32_t>(cells_.fragments.size()));
                    cells_.fragments.push_back(made);
                    ++cells_.fragment_count[fragment.triangle];
                }
                is_first = false;
            }
        }
    }

    /// Returns true if the body lies above a fragment in the plane.
    [[nodiscard]] bool is_body_above(const Fragment& fragment, const Plane& plane) const {
        Double3 p = {0, 0, 0};
        for (const std::uint32_t place : fragment.place) {
            const Double3 corner = middle(cells_.places[place]);
            p = {p.x + corner.x / 3, p.y + corner.y / 3, p.z + corner.z / 3};
        }
        const double step = kStep * near_;
        return is_in_body(
            {p.x + step * plane.normal.x, p.y + step * plane.normal.y, p.z + step * plane.normal.z},
            solid_.body_of(fragment.triangle));
    }

    [[nodiscard]] bool is_in_body(const Double3& p, std::uint32_t body) const {
        const auto around = solid_.bodies_around(p);
        return std::binary_search(around.begin(), around.end(), body);
    }

    [[nodiscard]] Double3 centre(const Region& region) const {
        const double share = 1.0 / static_cast<double>(region.corners.size());
        Double3 sum = {0, 0, 0};
        for (const RegionCorner& corner : region.corners) {
            const Double3 p = middle(cells_.places[corner.place]);
            sum = {sum.x + share * p.x, sum.y + share * p.y, sum.z + share * p.z};
        }
        return sum;
    }

    /// Makes a cell of the region. Returns true if the cell is convex.
    bool close(const Region& region) {
        SolidCell cell{{}, region.body, region.fragments, {}};
        std::vector<Double3> points;
        for (const std::uint32_t fragment : region.fragments) {
            for (const std::uint32_t number : cells_.fragments[fragment].place) {
                const Place& place = cells_.places[number];
                points.insert(points.end(), {place.lower, place.upper});
            }
        }
        const std::size_t of_fragments = points.size();
        const Double3 inside = centre(region);
        for (const RegionCorner& corner : region.corners) {
            const Place& place = cells_.places[corner.place];
            const Double3 p = middle(place);
            if (!is_corner_of_body(p, inside, region.body)) continue;
            const auto is_near = [&](const Double3& other) {
                const Double3 apart = mesh::minus(other, p);
                return mesh::dot(apart, apart) <= near_ * near_;
            };
            const auto end = points.begin() + static_cast<std::ptrdiff_t>(of_fragments);
            if (std::any_of(points.begin(), end, is_near)) continue;
            add_corner(place, region.body, is_near, cell);
        }
        points.insert(points.end(), cell.corners.begin(), cell.corners.end());
        for (const Double3& p : points) cell.box.add(p);
        const ConvexHull hull = convex_hull(points);
        cells_.cells.push_back(std::move(cell));
        return bound_flush(hull, solid_, kStep * near_).has_value();
    }

    /// Adds a corner. A vertex of the body replaces a corner that differs from it by rounding only.
    template <class IsNear>
    void add_corner(const Place& place, std::uint32_t body, const IsNear& is_near,
                    SolidCell& cell) const {
        for (const std::uint32_t t : triangles_of_[body]) {
            for (const std::uint32_t v : mesh_.triangles[t].vertex) {
                if (!is_near(position(v))) continue;
                cell.corners.push_back(position(v));
                return;
            }
        }
        const Double3& low = place.lower;
        const Double3& high = place.upper;
        for (unsigned k = 0; k < 8; ++k) {
            const Double3 corner = {(k & 1U) == 0 ? low.x : high.x, (k & 2U) == 0 ? low.y : high.y,
                                    (k & 4U) == 0 ? low.z : high.z};
            if (std::find(cell.corners.begin(), cell.corners.end(), corner) == cell.corners.end()) {
                cell.corners.push_back(corner);
            }
        }
    }

    /// Returns true if a corner of the region belongs to the body. A corner on the surface belongs
    /// only if the body continues from it within the region. If it does in part, fragments end in
    /// the corner.
    [[nodiscard]] bool is_corner_of_body(const Double3& corner, const Double3& inside,
                                         std::uint32_t body) const {
        if (solid_.tree().nearest(corner).distance > near_) return is_in_body(corner, body);
        const Double3 away = mesh::minus(inside, corner);
        const double length = std::sqrt(mesh::dot(away, away));
        const double share = std::min(0.5, std::max(kInwards, kStep * near_ / length));
        return is_in_body(
            {corner.x + share * away.x, corner.y + share * away.y, corner.z + share * away.z},
            body);
    }

    const mesh::Mesh& mesh_;
    const Solid& solid_;
    const std::vector<bool>& is_wanted_;
    double near_;
    std::vector<std::vector<std::uint32_t>> triangles_of_;  ///< of each wanted body
    SurfaceEdges edges_;
    SolidCells cells_;
    std::uint32_t plane_number_ = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> met_;  ///< cuts by this plane
};

}  // namespace

std::optional<SolidCells> cut_along_faces(const mesh::Mesh& mesh, const Solid& solid,
                                          const std::vector<bool>& is_wanted) {
    if (!solid.encloses()) return std::nullopt;
    return FaceCutter(mesh, solid, is_wanted).run();
}

}  // namespace cdprep::convex
