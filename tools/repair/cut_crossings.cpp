// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/cut_crossings.h"

// A build with assertions would print advice about another class, for each cut.
#define CGAL_NO_CDT_2_WARNING
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <map>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = ExactKernel::Point_3;
using Flat = ExactKernel::Point_2;

/// The number of the exact point that a vertex of a flat triangulation represents.
struct Number {
    std::uint32_t value = kNone;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Number, ExactKernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<ExactKernel>;
using Flattened = CGAL::Constrained_Delaunay_triangulation_2<
    ExactKernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::Exact_intersections_tag>;

constexpr int kMostCuts = 12;

Point exact(const Double3& p) {
    return {p.x, p.y, p.z};
}

double component(const Double3& p, int axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

Flat flat(const Point& p, int dropped) {
    return {p[(dropped + 1) % 3], p[(dropped + 2) % 3]};
}

/// Returns the axis along which the projection of a triangle is best; the projection has area.
int best_axis(const Corners& c) {
    const Double3 u{c[1].x - c[0].x, c[1].y - c[0].y, c[1].z - c[0].z};
    const Double3 v{c[2].x - c[0].x, c[2].y - c[0].y, c[2].z - c[0].z};
    const std::array<double, 3> size = {std::fabs(u.y * v.z - u.z * v.y),
                                        std::fabs(u.z * v.x - u.x * v.z),
                                        std::fabs(u.x * v.y - u.y * v.x)};
    std::array<int, 3> axes = {0, 1, 2};
    std::sort(axes.begin(), axes.end(), [&](int a, int b) {
        return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)];
    });
    for (const int axis : axes) {
        const auto seen = [axis](const Double3& p) {
            return Double2{component(p, (axis + 1) % 3), component(p, (axis + 2) % 3)};
        };
        if (exact::orient2d(seen(c[0]), seen(c[1]), seen(c[2])) != 0) return axis;
    }
    return axes[0];
}

/// Exact points by number: first the vertices of the mesh, then the points that cuts make.
class ExactPoints {
public:
    explicit ExactPoints(const std::vector<Double3>& positions) : positions_(positions) {}

    /// Registers a vertex of the mesh.
    void know(std::uint32_t vertex) {
        numbers_.try_emplace(exact(positions_[vertex]), vertex);
    }
    std::uint32_t number_of(const Point& p) {
        const auto next = static_cast<std::uint32_t>(positions_.size() + added_.size());
        const auto [at, is_new] = numbers_.try_emplace(p, next);
        if (is_new) added_.push_back(p);
        return at->second;
    }
    [[nodiscard]] const std::vector<Point>& added() const {
        return added_;
    }

private:
    const std::vector<Double3>& positions_;
    std::map<Point, std::uint32_t> numbers_;
    std::vector<Point> added_;
};

/// A triangle that is cut along its intersections with other triangles.
class CutTriangle {
    using Shape = ExactKernel::Triangle_3;
    using Segment = std::array<Point, 2>;
    using Sides = std::array<int, 3>;

public:
    CutTriangle(const RepairMesh& mesh, std::uint32_t t, ExactPoints& points)
        : points_(points),
          corners_(corners_of(mesh, t)),
          shape_(shape_of(corners_)),
          axis_(best_axis(corners_)) {
        for (int k = 0; k < 3; ++k) insert(shape_[k]);
    }

    static Corners corners_of(const RepairMesh& mesh, std::uint32_t t) {
        const auto& v = mesh.triangles[t].vertex;
        return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
    }

    /// Cuts along the part of the other triangle that is in this one. What two planes have in
    /// common ends where a side of one triangle meets the other triangle.
    void cut_along(const Corners& other) {
        const Sides of_other = exact::plane_signs(corners_, other);
        const std::vector<Segment> found = common_parts(other, of_other, shape_);
        if (of_other == Sides{0, 0, 0}) {
            for (const Segment& part : found) cut(part[0], part[1]);
            return;
        }
        std::vector<Point> ends;
        for (const Segment& part : found) ends.insert(ends.end(), part.begin(), part.end());
        const Sides own = exact::plane_signs(other, corners_);
        for (const Segment& part : common_parts(corners_, own, shape_of(other))) {
            ends.insert(ends.end(), part.begin(), part.end());
        }
        if (ends.empty()) return;
        const auto [least, greatest] = std::minmax_element(ends.begin(), ends.end());
        cut(*least, *greatest);
    }

    /// Returns the fragments, with the winding of the triangle.
    std::vector<Triangle> fragments() {
        for (auto v = flat_.finite_vertices_begin(); v != flat_.finite_vertices_end(); ++v) {
            if (v->info().value == kNone) v->info().value = points_.number_of(lifted(v->point()));
        }
        const bool turned = CGAL::orientation(flat(shape_[0], axis_), flat(shape_[1], axis_),
                                              flat(shape_[2], axis_)) == CGAL::RIGHT_TURN;
        std::vector<Triangle> fragments;
        for (auto f = flat_.finite_faces_begin(); f != flat_.finite_faces_end(); ++f) {
            Triangle fragment{{f->vertex(0)->info().value, f->vertex(1)->info().value,
                               f->vertex(2)->info().value}};
            if (turned) std::swap(fragment.vertex[1], fragment.vertex[2]);
            fragments.push_back(fragment);
        }
        return fragments;
    }

private:
    static Shape shape_of(const Corners& c) {
        return Shape{exact(c[0]), exact(c[1]), exact(c[2])};
    }

    /// Returns what each side of a triangle has in common with another; a point as a segment.
    /// CGAL::intersection() of two triangles does the same, but takes half as long again to
    /// compile.
    static std::vector<Segment> common_parts(const Corners& corners, const Sides& sides,
                                             const Shape& other) {
        std::vector<Segment> parts;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            if (sides[k] * sides[next] > 0) continue;
            const auto common = CGAL::intersection(
                ExactKernel::Segment_3(exact(corners[k]), exact(corners[next])), other);
            if (!common) continue;
            if (const auto* point = boost::get<Point>(&*common)) {
                parts.push_back({*point, *point});
            } else {
                const auto& segment = boost::get<ExactKernel::Segment_3>(*common);
                parts.push_back({segment.source(), segment.target()});
            }
        }
        return parts;
    }

    Flattened::Vertex_handle insert(const Point& p) {
        const auto vertex = flat_.insert(flat(p, axis_));
        if (vertex->info().value == kNone) vertex->info().value = points_.number_of(p);
        return vertex;
    }
    void cut(const Point& a, const Point& b) {
        if (a == b) {
            insert(a);
            return;
        }
        flat_.insert_constraint(insert(a), insert(b));
    }

    /// Returns the point of the triangle's plane that projects to p.
    [[nodiscard]] Point lifted(const Flat& p) const {
        const Flat a = flat(shape_[0], axis_), b = flat(shape_[1], axis_),
                   c = flat(shape_[2], axis_);
        const ExactKernel::FT whole = CGAL::determinant(b - a, c - a);
        const ExactKernel::FT along_b = CGAL::determinant(p - a, c - a) / whole;
        const ExactKernel::FT along_c = CGAL::determinant(b - a, p - a) / whole;
        return shape_[0] + along_b * (shape_[1] - shape_[0]) + along_c * (shape_[2] - shape_[0]);
    }

    ExactPoints& points_;
    Corners corners_;
    Shape shape_;
    int axis_;
    Flattened flat_;
};

bool is_allowed(const TriangleMeeting& meeting) {
    return meeting.meeting == Meeting::duplicate;
}

/// Returns the mesh with equal positions joined, without triangles of zero area.
RepairMesh joined(RepairMesh mesh) {
    mesh = weld_vertices(std::move(mesh), 0).mesh;
    std::vector<bool> kept(mesh.triangles.size());
    for (std::uint32_t t = 0; t < kept.size(); ++t) {
        kept[t] = !repeats_corner(mesh.triangles[t]) &&
                  !exact::is_degenerate(CutTriangle::corners_of(mesh, t));
    }
    keep_triangles(mesh, kept);
    return mesh;
}

/// Replaces each triangle of a meeting by its fragments, in place. Returns nothing if stopped.
std::optional<RepairMesh> cut_once(RepairMesh mesh, const std::vector<TriangleMeeting>& meetings,
                                   const StopCheck& stop) {
    std::vector<std::vector<std::uint32_t>> others(mesh.triangles.size());
    for (const TriangleMeeting& meeting : meetings) {
        if (is_allowed(meeting)) continue;
        others[meeting.a].push_back(meeting.b);
        others[meeting.b].push_back(meeting.a);
    }
    ExactPoints points(mesh.positions);
    for (std::size_t t = 0; t < others.size(); ++t) {
        if (others[t].empty()) continue;
        for (const std::uint32_t vertex : mesh.triangles[t].vertex) points.know(vertex);
    }
    std::vector<Triangle> triangles;
    std::vector<Origin> origins;
    for (std::uint32_t t = 0; t < others.size(); ++t) {
        if (others[t].empty()) {
            triangles.push_back(mesh.triangles[t]);
            origins.push_back(mesh.triangle_origin[t]);
            continue;
        }
        CutTriangle cut(mesh, t, points);
        for (const std::uint32_t other : others[t]) {
            if (is_stopped(stop)) return std::nullopt;
            cut.cut_along(CutTriangle::corners_of(mesh, other));
        }
        const std::vector<Triangle> fragments = cut.fragments();
        Origin origin = mesh.triangle_origin[t];
        if (fragments.size() > 1) origin.step = RepairStep::resolve_self_intersections;
        triangles.insert(triangles.end(), fragments.begin(), fragments.end());
        origins.insert(origins.end(), fragments.size(), origin);
    }
    for (const Point& p : points.added()) {
        const auto& q = p.exact();  // so that the double does not depend on the history of p
        mesh.positions.push_back(
            {CGAL::to_double(q.x()), CGAL::to_double(q.y()), CGAL::to_double(q.z())});
        mesh.vertex_origin.push_back({kNone, RepairStep::resolve_self_intersections});
        mesh.single_precision = false;
    }
    mesh.triangles = std::move(triangles);
    mesh.triangle_origin = std::move(origins);
    return mesh;
}

}  // namespace

CutMesh cut_crossings(RepairMesh mesh, const SearchOptions& search, const StopCheck& stop) {
    mesh = joined(std::move(mesh));
    CutMesh cut;
    std::size_t before = std::numeric_limits<std::size_t>::max();
    try {
        for (int round = 0; round <= kMostCuts; ++round) {
            const auto [meetings, is_complete] = find_meetings(mesh, search);
            if (!is_complete) {
                cut.failed = "a limit ended the search for crossings of their cuts";
                return cut;
            }
            const auto worst = std::find_if_not(meetings.begin(), meetings.end(), is_allowed);
            cut.left.reset();
            if (worst == meetings.end()) break;
            cut.left = *worst;
            // Rounded cuts that create as many meetings as they remove would continue forever.
            if (round == kMostCuts || meetings.size() >= before) break;
            before = meetings.size();
            std::optional<RepairMesh> fragments = cut_once(std::move(mesh), meetings, stop);
            if (!fragments) {
                cut.failed = "cutting them took longer than the time limit";
                return cut;
            }
            mesh = joined(std::move(*fragments));
        }
    } catch (const std::exception& error) {
        cut.failed = "the exact cut failed: ";
        cut.failed += error.what();
    }
    cut.mesh = std::move(mesh);
    return cut;
}

}  // namespace cdprep::mesh
