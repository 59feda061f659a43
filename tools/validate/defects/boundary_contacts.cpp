// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary parts that come near each other: T-junctions and seams with a gap.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "cdprep/exact/triangles.h"
#include "mesh/close_groups.h"
#include "mesh/vectors.h"
#include "validate/defects/boundary.h"
#include "validate/defects/source_places.h"

namespace cdprep::mesh {
namespace {

/// A test of the boxes that come within a margin of a segment. It is conservative: it never
/// rejects a box within the margin. The separating axes are those of the box and their cross
/// products with the segment. The margin grows by a bound on the rounding error.
class SegmentReach {
public:
    SegmentReach(const Double3& p, const Double3& q, double margin)
        : middle_(middle_of(p, q)), half_(minus(q, middle_of(p, q))), margin_(margin) {
        size_ = {std::fabs(half_.x), std::fabs(half_.y), std::fabs(half_.z)};
    }

    bool operator()(const Box& box) const {
        const Double3 centre = middle_of(box.lower, box.upper);
        const Double3 h = {grown(box.upper.x - centre.x, centre.x),
                           grown(box.upper.y - centre.y, centre.y),
                           grown(box.upper.z - centre.z, centre.z)};
        const Double3 d = minus(middle_, centre);
        if (std::fabs(d.x) > h.x + size_.x || std::fabs(d.y) > h.y + size_.y ||
            std::fabs(d.z) > h.z + size_.z) {
            return false;
        }
        return !apart(d.y, d.z, half_.y, half_.z, h.y, h.z) &&
               !apart(d.z, d.x, half_.z, half_.x, h.z, h.x) &&
               !apart(d.x, d.y, half_.x, half_.y, h.x, h.y);
    }

private:
    static constexpr double kRounding = 0x1p-48;  // 32 ulp; at most a few dozen operations

    /// Returns half the box's width plus the margin and the possible error of coordinates.
    [[nodiscard]] double grown(double half, double centre) const {
        const double coordinate = std::fabs(centre) + std::fabs(half) + largest_middle();
        return half + margin_ + kRounding * (coordinate + margin_) +
               std::numeric_limits<double>::min();
    }
    [[nodiscard]] double largest_middle() const {
        return std::max({std::fabs(middle_.x) + size_.x, std::fabs(middle_.y) + size_.y,
                         std::fabs(middle_.z) + size_.z});
    }
    static bool apart(double d1, double d2, double s1, double s2, double h1, double h2) {
        const double a = d1 * s2, b = d2 * s1;
        const double reach = h1 * std::fabs(s2) + h2 * std::fabs(s1);
        return std::fabs(a - b) > reach + kRounding * (std::fabs(a) + std::fabs(b) + reach) +
                                      std::numeric_limits<double>::min();
    }

    Double3 middle_;
    Double3 half_;
    Double3 size_{};
    double margin_;
};

Box box_of(const Double3& a, const Double3& b) {
    Box box;
    box.add(a);
    box.add(b);
    return box;
}

/// Returns whether p lies exactly on the segment, ends included.
bool lies_on(const Double3& p, const Double3& a, const Double3& b) {
    return box_of(a, b).contains(p) && exact::is_degenerate({a, p, b});
}

struct OnSegment {
    double share;  ///< of the nearest point, from 0 to 1
    double distance;
};

OnSegment nearest_on(const Double3& p, const Double3& a, const Double3& b) {
    const Double3 u = minus(b, a);
    const Double3 v = minus(p, a);
    const double length = std::hypot(u.x, u.y, u.z);
    // A unit direction: squares of lengths may leave the range of double.
    const Double3 unit = {u.x / length, u.y / length, u.z / length};
    const double along = dot(v, unit);
    const double share = std::clamp(along / length, 0.0, 1.0);
    const Double3 at = {a.x + share * u.x, a.y + share * u.y, a.z + share * u.z};
    return {share, distance_between(p, share < 1 ? at : b)};
}

PointTree tree_of(const Mesh& mesh, const Boundary& boundary) {
    std::vector<Double3> points;
    for (const std::uint32_t vertex : boundary.vertex) points.push_back(mesh.positions[vertex]);
    return PointTree(std::move(points));
}

/// The basic limit on tests of an edge against a vertex; 0.1 us each makes some 5 s.
constexpr std::uint64_t kLooksAtVertices = 50'000'000;
constexpr std::uint64_t kLooksPerEdge = 200;  ///< sound boundaries use 10 to 30
constexpr std::uint32_t kEdgesPerCheck = 256;

/// An end of the boundary, and an edge that it does not belong to.
struct Contact {
    std::uint32_t end;  ///< index into Boundary::vertex
    std::uint32_t edge;
    OnSegment nearest;
};

/// Returns all contacts within a width, without the ends that lie on the edge.
std::vector<Contact> contacts_within(const Mesh& mesh, const Boundary& boundary, double width) {
    const PointTree tree = tree_of(mesh, boundary);
    std::vector<Contact> contacts;
    for (std::uint32_t i = 0; i < boundary.edge.size(); ++i) {
        const FlawedEdge& edge = boundary.edge[i];
        const Double3& from = mesh.positions[edge.from];
        const Double3& to = mesh.positions[edge.to];
        tree.visit(SegmentReach(from, to, width), [&](std::uint32_t end) {
            // Between a corner and the edges of its triangle lies surface, not a gap.
            const auto& corners = mesh.triangles[edge.triangle].vertex;
            const std::uint32_t vertex = boundary.vertex[end];
            if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) return;
            const OnSegment nearest = nearest_on(tree.point(end), from, to);
            if (!(nearest.distance <= width) || lies_on(tree.point(end), from, to)) return;
            contacts.push_back({end, i, nearest});
        });
    }
    return contacts;
}

/// The least distance along the boundary between two sides of a gap, in seam widths. Neighbours
/// around a corner are near each other without a gap.
constexpr double kFarAlong = 4;

/// The ends within a given length along the boundary.
class NearAlong {
public:
    NearAlong(const Mesh& mesh, const Boundary& boundary, std::uint32_t end, double length)
        : boundary_(boundary) {
        using Reached = std::pair<double, std::uint32_t>;
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
        open.push({0, end});
        while (!open.empty()) {
            const auto [distance, at] = open.top();
            open.pop();
            if (!ends_.insert(at).second) continue;
            for (const std::uint32_t i : boundary.edges_of(at)) {
                const FlawedEdge& edge = boundary.edge[i];
                const double next =
                    distance + distance_between(mesh.positions[edge.from], mesh.positions[edge.to]);
                if (!(next <= length)) continue;
                for (const std::uint32_t vertex : {edge.from, edge.to}) {
                    open.push({next, boundary.end_at(vertex)});
                }
            }
        }
    }

    /// Returns whether an end of the edge is among them.
    [[nodiscard]] bool reaches(std::uint32_t edge) const {
        return ends_.contains(boundary_.end_at(boundary_.edge[edge].from)) ||
               ends_.contains(boundary_.end_at(boundary_.edge[edge].to));
    }

private:
    const Boundary& boundary_;
    std::set<std::uint32_t> ends_;
};

Place place_of(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
               const Contact& contact, double measure) {
    const std::uint32_t vertex = boundary.vertex[contact.end];
    const std::uint32_t own_triangle =
        boundary.edge[boundary.edges_of(contact.end).front()].triangle;
    const FlawedEdge& edge = boundary.edge[contact.edge];
    Place place = place_of_edge(soup, sound, edge, measure);
    place.vertices.insert(place.vertices.begin(), source_corner(soup, sound, own_triangle, vertex));
    if (own_triangle != edge.triangle) {
        place.triangles.push_back(sound.source_triangle[own_triangle]);
        std::sort(place.triangles.begin(), place.triangles.end());
    }
    place.position = sound.mesh.positions[vertex];
    return place;
}

}  // namespace

bool find_t_junctions(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                      const StopCheck& stop, FindingList& findings, DefectCounts& counts) {
    if (boundary.edge.empty()) return true;
    const std::uint64_t most = kLooksAtVertices + kLooksPerEdge * boundary.edge.size();
    std::uint64_t looks = 0;
    const PointTree tree = tree_of(sound.mesh, boundary);
    std::vector<std::uint32_t> ends;
    for (std::uint32_t i = 0; i < boundary.edge.size(); ++i) {
        const FlawedEdge& edge = boundary.edge[i];
        const Double3& from = sound.mesh.positions[edge.from];
        const Double3& to = sound.mesh.positions[edge.to];
        ends.clear();
        const Box around = box_of(from, to);
        const SegmentReach reach(from, to, 0);
        // Plain comparisons decide most boxes.
        const auto enter = [&](const Box& box) {
            return around.meets(box) && (box.contains(from) || reach(box));
        };
        if (looks > most || (i % kEdgesPerCheck == 0 && is_stopped(stop))) {
            findings.mark_lower_bound(Rule::t_junction);
            return false;
        }
        tree.visit(enter, [&](std::uint32_t end) {
            ++looks;
            if (!around.contains(tree.point(end))) return;
            const std::uint32_t vertex = boundary.vertex[end];
            if (vertex == edge.from || vertex == edge.to) return;
            if (lies_on(tree.point(end), from, to)) ends.push_back(end);
        });
        std::sort(ends.begin(), ends.end());
        for (const std::uint32_t end : ends) {
            ++counts.t_junctions;
            findings.add(Rule::t_junction, [&] {
                const Contact contact{end, i, nearest_on(tree.point(end), from, to)};
                return place_of(soup, sound, boundary, contact, contact.nearest.share);
            });
        }
    }
    return true;
}

void find_near_seams(const TriangleSoup& soup, const SoundMesh& sound, const Boundary& boundary,
                     double width, FindingList& findings, DefectCounts& counts) {
    if (boundary.edge.empty() || !(width > 0)) return;
    std::vector<Contact> contacts = contacts_within(sound.mesh, boundary, width);
    std::sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) {
        return std::tie(a.end, a.nearest.distance, a.edge) <
               std::tie(b.end, b.nearest.distance, b.edge);
    });
    for (auto first = contacts.begin(); first != contacts.end();) {
        const std::uint32_t end = first->end;
        const auto last =
            std::find_if(first, contacts.end(), [end](const Contact& c) { return c.end != end; });
        const NearAlong near_along(sound.mesh, boundary, end, kFarAlong * width);
        const auto seam = std::find_if(
            first, last, [&](const Contact& contact) { return !near_along.reaches(contact.edge); });
        if (seam != last) {
            ++counts.near_seams;
            findings.add(Rule::near_seam, [&] {
                return place_of(soup, sound, boundary, *seam, seam->nearest.distance);
            });
        }
        first = last;
    }
}

}  // namespace cdprep::mesh
