// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/epeck.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cdprep::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;

/// Coordinates that came from doubles.
Double3 in_doubles(const Point& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

std::vector<Point> corners_of(const CGAL::Object& hull) {
    if (const auto* point = CGAL::object_cast<Point>(&hull)) return {*point};
    if (const auto* segment = CGAL::object_cast<Kernel::Segment_3>(&hull)) {
        return {segment->source(), segment->target()};
    }
    if (const auto* triangle = CGAL::object_cast<Kernel::Triangle_3>(&hull)) {
        return {triangle->vertex(0), triangle->vertex(1), triangle->vertex(2)};
    }
    const auto* polyhedron = CGAL::object_cast<Polyhedron>(&hull);
    if (polyhedron == nullptr) throw std::logic_error("a hull of another kind");
    return {polyhedron->points_begin(), polyhedron->points_end()};
}

bool lie_in_one_plane(const std::vector<Point>& p) {
    return std::all_of(p.begin(), p.end(),
                       [&](const Point& q) { return CGAL::coplanar(p[0], p[1], p[2], q); });
}

bool is_point(const std::vector<Double3>& positions, std::uint32_t vertex) {
    if (vertex >= positions.size()) return false;
    const Double3& p = positions[vertex];
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Those with an area.
std::vector<Kernel::Triangle_3> sound_triangles(const TestMesh& mesh) {
    std::vector<Kernel::Triangle_3> sound;
    for (const Triangle& t : mesh.triangles) {
        if (!std::all_of(t.vertex.begin(), t.vertex.end(),
                         [&](std::uint32_t v) { return is_point(mesh.positions, v); })) {
            continue;
        }
        const auto at = [&](std::size_t i) {
            const Double3& p = mesh.positions[t.vertex[i]];
            return Point(p.x, p.y, p.z);
        };
        const Kernel::Triangle_3 triangle(at(0), at(1), at(2));
        if (!triangle.is_degenerate()) sound.push_back(triangle);
    }
    return sound;
}

bool meet_elsewhere(const Kernel::Triangle_3& a, const Kernel::Triangle_3& b) {
    if (!CGAL::do_overlap(a.bbox(), b.bbox())) return false;
    const auto met = CGAL::intersection(a, b);
    if (!met) return false;
    int common = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) common += a.vertex(i) == b.vertex(j) ? 1 : 0;
    }
    if (common == 1) return boost::get<Point>(&*met) == nullptr;
    if (common == 2) return boost::get<Kernel::Segment_3>(&*met) == nullptr;
    return true;
}

}  // namespace

EpeckHull epeck_hull(const std::vector<Double3>& points) {
    std::vector<Point> exact;
    for (const Double3& p : points) exact.emplace_back(p.x, p.y, p.z);
    // CGAL 5.5 takes the first of collinear points for an end of their segment.
    std::sort(exact.begin(), exact.end());
    CGAL::Object hull;
    CGAL::convex_hull_3(exact.begin(), exact.end(), hull);
    const std::vector<Point> corners = corners_of(hull);
    EpeckHull result;
    result.dimension = corners.size() <= 2         ? static_cast<int>(corners.size()) - 1
                       : lie_in_one_plane(corners) ? 2
                                                   : 3;
    for (const Point& p : corners) result.corners.push_back(in_doubles(p));
    return result;
}

std::size_t epeck_meeting_pairs(const TestMesh& mesh) {
    const std::vector<Kernel::Triangle_3> triangles = sound_triangles(mesh);
    std::size_t count = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (std::size_t j = i + 1; j < triangles.size(); ++j) {
            if (meet_elsewhere(triangles[i], triangles[j])) ++count;
        }
    }
    return count;
}

}  // namespace cdprep::test
