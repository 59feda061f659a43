// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "cdprep/exact/predicates.h"
#include "mesh/around_edge.h"
#include "repair/cut_crossings.h"
#include "repair/ray_along_x.h"
#include "repair/repair_steps.h"
#include "repair/stored_verdict.h"
#include "repair/test_points.h"

namespace cdprep::mesh {
namespace {

/// One triangle for all with the same corners. The count is the number of those with its winding
/// minus the number of the others.
struct Facet {
    Triangle triangle;
    std::uint32_t first;  ///< the lowest triangle of the mesh
    std::uint32_t last;   ///< the highest
    int count = 0;
};

std::vector<Facet> join_facets(const std::vector<Triangle>& triangles) {
    struct Key {
        std::array<std::uint32_t, 3> corners;
        std::uint32_t triangle;
        bool turned;
        bool operator<(const Key& other) const {
            return corners != other.corners ? corners < other.corners : triangle < other.triangle;
        }
    };
    std::vector<Key> keys;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        std::array<std::uint32_t, 3> c = {triangles[t].vertex[0], triangles[t].vertex[1],
                                          triangles[t].vertex[2]};
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        const bool turned = c[1] > c[2];
        if (turned) std::swap(c[1], c[2]);
        keys.push_back({c, t, turned});
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Facet> facets;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (i == 0 || keys[i].corners != keys[i - 1].corners) {
            const auto& c = keys[i].corners;
            facets.push_back({{{c[0], c[1], c[2]}}, keys[i].triangle, keys[i].triangle});
        }
        facets.back().last = keys[i].triangle;
        facets.back().count += keys[i].turned ? -1 : 1;
    }
    return facets;
}

/// The winding numbers on both sides of every facet of a mesh without crossings.
///
/// Around each edge, neighbouring facets bound a common wedge. Their sides there belong to one
/// cell, and each cell has one number. Across a facet the number changes by the facet's count.
/// One number per part (facets connected by edges) is then still open. It is determined at the
/// part's outer side, where it equals the winding number of the other parts.
class Windings {
public:
    Windings(const std::vector<Double3>& positions, const std::vector<Facet>& facets)
        : positions_(positions),
          facets_(facets),
          cells_(2 * facets.size()),
          parts_(facets.size()),
          number_(2 * facets.size(), 0) {
        for (const Facet& facet : facets) triangles_.push_back(facet.triangle);
        edges_ = find_edge_uses(triangles_, positions.size());
        join_sides();
    }

    /// Returns why the numbers are unknown; empty if they are found, or if stopped.
    std::string find(const StopCheck& stop) {
        std::vector<std::vector<std::uint32_t>> members(facets_.size());
        for (std::uint32_t f = 0; f < facets_.size(); ++f) members[parts_.lowest(f)].push_back(f);
        collect_links();
        for (const auto& part : members) {
            if (part.empty()) continue;
            if (std::string why = number_part(part, stop); !why.empty()) return why;
        }
        return {};
    }

    /// Return the number in front of a facet, where its normal points, and behind it.
    [[nodiscard]] int front(std::uint32_t facet) const {
        return number_[std::size_t{2} * facet];
    }
    [[nodiscard]] int behind(std::uint32_t facet) const {
        return number_[std::size_t{2} * facet + 1];
    }

private:
    /// Returns the side of a half-edge's facet that follows it by ascending angle. It is the
    /// front of a facet that closes, and the back of one that opens.
    static std::uint32_t side_after(const AroundEdge& around, HalfEdge h) {
        return 2 * (h / 3) + (around.opens(h) ? 1 : 0);
    }
    static std::uint32_t side_before(const AroundEdge& around, HalfEdge h) {
        return 2 * (h / 3) + (around.opens(h) ? 0 : 1);
    }

    void join_sides() {
        for (std::size_t edge = 0; edge < edges_.edge_count(); ++edge) {
            const auto uses = edges_.of(edge);
            const AroundEdge around(positions_, triangles_, uses);
            const std::vector<HalfEdge> order = around.sorted(uses);
            for (std::size_t i = 0; i < order.size(); ++i) {
                const HalfEdge next = order[(i + 1) % order.size()];
                cells_.join(side_after(around, order[i]), side_before(around, next));
                parts_.join(order[i] / 3, next / 3);
            }
        }
    }

    /// Collects the facet sides of each cell.
    void collect_links() {
        links_.resize(2 * facets_.size());
        for (std::uint32_t side = 0; side < 2 * facets_.size(); ++side) {
            links_[cells_.lowest(side)].push_back(side);
        }
    }

    std::string number_part(const std::vector<std::uint32_t>& part, const StopCheck& stop) {
        const std::optional<std::uint32_t> side_outside = outer_side(part);
        if (!side_outside) return "the outside of a part is unknown";
        const std::uint32_t outer = cells_.lowest(*side_outside);
        std::vector<std::optional<int>>& known = known_;
        known.resize(2 * facets_.size());
        known[outer] = number_of_others(part, stop);
        if (is_stopped(stop)) return {};
        if (!known[outer]) return "a part touches others at every point that was tested";
        std::deque<std::uint32_t> queue = {outer};
        while (!queue.empty()) {
            const std::uint32_t cell = queue.front();
            queue.pop_front();
            for (const std::uint32_t side : links_[cell]) {
                number_[side] = *known[cell];
                // The number behind a facet exceeds the number in front by the facet's count.
                const int change = facets_[side / 2].count * (side % 2 == 0 ? 1 : -1);
                const std::uint32_t across = cells_.lowest(side ^ 1U);
                if (!known[across]) {
                    known[across] = *known[cell] + change;
                    queue.push_back(across);
                } else if (*known[across] != *known[cell] + change) {
                    return "the winding numbers around a cut edge are inconsistent";
                }
            }
        }
        return {};
    }

    /// Returns a side that faces the outside of the part. At the part's lowest vertex, takes the
    /// edge that bounds the outline as projected along z. Beyond this edge there is nothing.
    /// Returns nothing if no finite point lies beyond it.
    std::optional<std::uint32_t> outer_side(const std::vector<std::uint32_t>& part) const {
        const auto less = [&](std::uint32_t a, std::uint32_t b) {
            const Double3 &p = positions_[a], &q = positions_[b];
            return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
        };
        std::uint32_t lowest = triangles_[part[0]].vertex[0];
        for (const std::uint32_t f : part) {
            for (const std::uint32_t vertex : triangles_[f].vertex) {
                if (less(vertex, lowest)) lowest = vertex;
            }
        }
        const auto seen = [&](std::uint32_t vertex) {
            return Double2{positions_[vertex].x, positions_[vertex].y};
        };
        HalfEdge outline = kNone;
        std::uint32_t to = kNone;
        for (const std::uint32_t f : part) {
            for (HalfEdge h = 3 * f; h < 3 * f + 3; ++h) {
                const std::uint32_t a = start_of(triangles_, h), b = end_of(triangles_, h);
                if (a != lowest && b != lowest) continue;
                const std::uint32_t other = a == lowest ? b : a;
                const Double2 at = seen(lowest), there = seen(other);
                if (at.x == there.x && at.y == there.y) continue;
                if (to == kNone || exact::orient2d(at, seen(to), there) < 0) {
                    outline = h;
                    to = other;
                }
            }
        }
        if (to == kNone) return std::nullopt;
        const Double2 at = seen(lowest), there = seen(to);
        const Double3 beyond = right_of(positions_[lowest], there.x > at.x);
        // The whole part lies to the left of the outline's edge, or on its line.
        if (exact::orient2d(at, there, {beyond.x, beyond.y}) >= 0) return std::nullopt;
        return first_side_from(outline, beyond, part);
    }

    /// Returns a point to the right of an edge from p, as seen along z. The edge goes to larger x,
    /// or straight to larger y.
    static Double3 right_of(const Double3& p, bool to_larger_x) {
        constexpr double kMost = std::numeric_limits<double>::max();
        if (to_larger_x) return {p.x, std::max(p.y - 1 - std::fabs(p.y), -kMost), p.z};
        return {std::min(p.x + 1 + std::fabs(p.x), kMost), p.y, p.z};
    }

    std::uint32_t first_side_from(HalfEdge outline, const Double3& beyond,
                                  const std::vector<std::uint32_t>& part) const {
        const std::uint32_t a = start_of(triangles_, outline), b = end_of(triangles_, outline);
        std::vector<HalfEdge> uses;
        for (const std::uint32_t f : part) {
            for (HalfEdge h = 3 * f; h < 3 * f + 3; ++h) {
                const std::uint32_t s = start_of(triangles_, h), e = end_of(triangles_, h);
                if ((s == a && e == b) || (s == b && e == a)) uses.push_back(h);
            }
        }
        const AroundEdge around(positions_, triangles_, outline, beyond);
        return side_before(around, around.sorted(uses).front());
    }

    /// Returns the winding number of all other parts at this one; nothing if all points tested
    /// lie on the others. Parts share no edge, so a part may touch others at all its vertices.
    std::optional<int> number_of_others(const std::vector<std::uint32_t>& part,
                                        const StopCheck& stop) {
        const std::uint32_t own = parts_.lowest(part[0]);
        const auto number = [&](const Double3& p) { return number_at(p, own); };
        return find_number_at_part(positions_, triangles_, part, number, stop);
    }

    std::optional<int> number_at(const Double3& p, std::uint32_t own) {
        int number = 0;
        for (std::uint32_t f = 0; f < facets_.size(); ++f) {
            if (parts_.lowest(f) == own) continue;
            const auto& v = triangles_[f].vertex;
            const WindingTerm term =
                winding_term_along_x(p, {positions_[v[0]], positions_[v[1]], positions_[v[2]]});
            if (term.on_surface) return std::nullopt;
            number += term.crossings * facets_[f].count;
        }
        return number;
    }

    const std::vector<Double3>& positions_;
    const std::vector<Facet>& facets_;
    std::vector<Triangle> triangles_;
    EdgeUses edges_;
    Groups cells_;             ///< of sides: 2 f is the front of facet f, 2 f + 1 its back
    Groups parts_;             ///< facets connected by edges
    std::vector<int> number_;  ///< by side
    std::vector<std::vector<std::uint32_t>> links_;
    std::vector<std::optional<int>> known_;  ///< by the lowest side of a cell
};

Stepped refused(RepairMesh mesh, const std::string& sentence,
                const std::vector<std::uint32_t>& triangles, const Double3& position) {
    StepReport report(RepairStep::resolve_self_intersections);
    report.refused.push_back({sentence, triangles, {}, position, 0});
    return {std::move(mesh), std::move(report)};
}

/// Refuses with a message about a pair, and its numbers.
Stepped refused_pair(RepairMesh mesh, const RepairMesh& fragments, std::uint32_t a, std::uint32_t b,
                     const std::string& why) {
    return refused(
        std::move(mesh),
        triangle_in_words(fragments, a) + " and " + triangle_in_words(fragments, b) + why,
        {fragments.triangle_origin[a].source, fragments.triangle_origin[b].source},
        fragments.positions[fragments.triangles[a].vertex[0]]);
}

/// Refuses because a limit or an interrupt ended the search for pairs.
Stepped refused_search(RepairMesh mesh, const Meetings& some) {
    return refused(std::move(mesh),
                   "at least " + std::to_string(some.pairs.size()) +
                       " pairs of triangles meet; a limit ended the search for more.",
                   {}, {});
}

/// Returns the facets between winding number 0 and another, wound outwards.
RepairMesh keep_boundary(const RepairMesh& mesh, const std::vector<Facet>& facets,
                         const Windings& windings) {
    std::vector<std::optional<Triangle>> kept(mesh.triangles.size());
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
        const bool front = windings.front(f) != 0, behind = windings.behind(f) != 0;
        if (front == behind) continue;
        Triangle triangle = facets[f].triangle;
        if (front) std::swap(triangle.vertex[1], triangle.vertex[2]);
        kept[facets[f].first] = triangle;
    }
    RepairMesh boundary = mesh;
    boundary.triangles.clear();
    boundary.triangle_origin.clear();
    for (std::size_t t = 0; t < kept.size(); ++t) {
        if (!kept[t]) continue;
        // Keeps the order of the corners if the winding is the same; the first corner always
        // stays.
        const Triangle& triangle = mesh.triangles[t];
        const auto& v = kept[t]->vertex;
        const auto at = std::find(v.begin(), v.end(), triangle.vertex[0]) - v.begin();
        const std::uint32_t next = v[(static_cast<std::size_t>(at) + 1) % 3];
        boundary.triangles.push_back(triangle);
        boundary.triangle_origin.push_back(mesh.triangle_origin[t]);
        if (next != triangle.vertex[1]) {
            turn(boundary, static_cast<std::uint32_t>(boundary.triangles.size() - 1));
        }
    }
    return boundary;
}

/// Records the triangles of `before` that are missing in `after`, and those that are cut.
void account(const RepairMesh& before, const RepairMesh& after, StepReport& report) {
    std::uint32_t most = 0;
    for (const Origin& origin : before.triangle_origin) {
        if (origin.source != kNone) most = std::max(most, origin.source + 1);
    }
    std::vector<bool> there(most, false), cut(most, false);
    for (const Origin& origin : after.triangle_origin) {
        if (origin.source == kNone) continue;
        there[origin.source] = true;
        if (origin.step == report.step) cut[origin.source] = true;
    }
    std::vector<bool> told(most, false);
    for (const Origin& origin : before.triangle_origin) {
        if (origin.source == kNone || told[origin.source]) continue;
        told[origin.source] = true;
        if (!there[origin.source]) report.dropped.push_back({origin.source, DropReason::inside});
        if (cut[origin.source]) report.cut.push_back(origin.source);
    }
    for (const Origin& origin : after.vertex_origin) {
        if (origin.step == report.step) ++report.added_vertices;
    }
}

}  // namespace

Stepped resolve_self_intersections(RepairMesh mesh, const SearchOptions& search,
                                   const StopCheck& stop) {
    const Meetings meetings = find_meetings(mesh, search);
    if (!meetings.is_complete) return refused_search(mesh, meetings);
    if (meetings.pairs.empty()) {
        return {std::move(mesh), StepReport(RepairStep::resolve_self_intersections)};
    }
    const TriangleMeeting& first = meetings.pairs.front();
    if (count_unpaired_uses(mesh.positions, mesh.triangles) > 0) {
        return refused_pair(mesh, mesh, first.a, first.b,
                            " meet, and the mesh is unbalanced, so it has no inside.");
    }
    CutMesh cut = cut_crossings(mesh, search, stop);
    if (!cut.failed.empty()) {
        return refused_pair(mesh, mesh, first.a, first.b, " meet, and " + cut.failed + ".");
    }
    if (cut.left) {
        return refused_pair(mesh, cut.mesh, cut.left->a, cut.left->b,
                            " still meet after their cuts were rounded.");
    }
    const std::vector<Facet> facets = join_facets(cut.mesh.triangles);
    Windings windings(cut.mesh.positions, facets);
    const std::string unknown = windings.find(stop);
    if (is_stopped(stop)) {
        return refused_pair(mesh, mesh, first.a, first.b,
                            " meet, and finding the inside took longer than the time limit.");
    }
    if (!unknown.empty()) {
        return refused_pair(mesh, mesh, first.a, first.b, " meet, and " + unknown + ".");
    }
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
        if (windings.front(f) == 0 && windings.behind(f) == 0) {
            return refused_pair(
                mesh, cut.mesh, facets[f].first, facets[f].last,
                " are two sides of a sheet that encloses nothing and would be lost.");
        }
    }
    Stepped parted = split_non_manifold(keep_boundary(cut.mesh, facets, windings));
    StepReport report(RepairStep::resolve_self_intersections);
    std::vector<std::uint32_t> unused;
    drop_unused_vertices(parted.mesh, unused);
    account(mesh, parted.mesh, report);
    report.unused = std::move(unused);
    report.parted = std::move(parted.report.parted);
    const Meetings after = find_meetings(parted.mesh, search);
    if (!after.pairs.empty()) {
        return refused_pair(mesh, parted.mesh, after.pairs[0].a, after.pairs[0].b,
                            " would still meet in the boundary of the solid.");
    }
    if (!after.is_complete) return refused_search(mesh, after);
    return {std::move(parted.mesh), std::move(report)};
}

}  // namespace cdprep::mesh
