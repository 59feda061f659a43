// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/patch_set.h"

#include <algorithm>
#include <numeric>

#include "decompose/surface/flat_turn.h"

namespace cdprep::convex {
namespace {

// The least number of vertices from which a patch keeps its hull. Smaller hulls are rebuilt on
// demand.
constexpr std::size_t kKeepHullFrom = 12;
// The largest number of vertices of a merged hull. Each merge examines the whole hull. Larger
// convex parts stay in several pieces unless close_convex_regions() took them.
constexpr std::size_t kMostHullVertices = 512;

}  // namespace

PatchSet::PatchSet(const PatchRules& rules)
    : rules_(rules), parent_(rules.mesh.triangles.size()), patches_(parent_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    own_number_ = parent_;
}

std::uint32_t PatchSet::patch_of(std::uint32_t triangle) {
    while (parent_[triangle] != triangle) {
        triangle = parent_[triangle] = parent_[parent_[triangle]];
    }
    return triangle;
}

std::span<const std::uint32_t> PatchSet::vertices(std::uint32_t patch) const {
    if (!patches_[patch].vertices.empty()) return patches_[patch].vertices;
    return rules_.mesh.triangles[patch].vertex;
}

std::span<const std::uint32_t> PatchSet::faces(std::uint32_t patch) const {
    if (!patches_[patch].faces.empty()) return patches_[patch].faces;
    return std::span(own_number_).subspan(patch, 1);
}

bool PatchSet::fit(std::uint32_t a, std::uint32_t b, PatchScope& scope) const {
    const auto admits_all = [&](std::uint32_t by, std::uint32_t of) {
        rules_.planes.gather(vertices(of), scope.points);
        const auto all = faces(by);
        return std::all_of(all.begin(), all.end(), [&](std::uint32_t face) {
            return rules_.planes.admits_all(face, scope.points);
        });
    };
    return admits_all(a, b) && admits_all(b, a);
}

bool PatchSet::lie_in_one_plane(std::uint32_t a, std::uint32_t b) const {
    if (!patches_[a].is_flat || !patches_[b].is_flat) return false;
    const Corners plane = rules_.solids.corners_of(faces(a)[0]);
    for (const Double3& p : rules_.solids.corners_of(faces(b)[0])) {
        if (exact::orient3d(plane[0], plane[1], plane[2], p) != 0) return false;
    }
    return true;
}

// A flat hull has no interior: it stays in the surface if it is no larger than the patch.
bool PatchSet::is_outline_convex(std::uint32_t a, std::uint32_t b) const {
    const mesh::Mesh& mesh = rules_.mesh;
    const Corners plane = rules_.solids.corners_of(faces(a)[0]);
    const int axis = axis_of_turn(plane[0], plane[1], plane[2]);
    const int turn = flat_turn(axis, plane[0], plane[1], plane[2]);
    const auto is_left = [&](mesh::HalfEdge h, std::uint32_t vertex) {
        return flat_turn(axis, mesh.positions[mesh::start_of(mesh.triangles, h)],
                         mesh.positions[mesh::end_of(mesh.triangles, h)],
                         mesh.positions[vertex]) != -turn;
    };
    const auto is_outline = [&](mesh::HalfEdge h) {
        const mesh::HalfEdge twin = rules_.edges.twin[h];
        if (twin == mesh::kNone) return true;
        const std::uint32_t beyond = owner_of(twin / 3);
        return beyond != a && beyond != b;
    };
    for (const std::uint32_t patch : {a, b}) {
        for (const std::uint32_t face : faces(patch)) {
            for (mesh::HalfEdge h = 3 * face; h < 3 * face + 3; ++h) {
                if (!is_outline(h)) continue;
                for (const std::uint32_t of : {a, b}) {
                    for (const std::uint32_t vertex : vertices(of)) {
                        if (!is_left(h, vertex)) return false;
                    }
                }
            }
        }
    }
    return true;
}

void PatchSet::make_hull(std::uint32_t a, std::uint32_t b, PatchScope& scope) const {
    const auto size = [&](std::uint32_t p) { return patches_[p].hull ? vertices(p).size() : 0; };
    if (size(a) < size(b)) std::swap(a, b);
    std::vector<Double3> points;
    const auto already = vertices(a);
    if (!patches_[a].hull) {
        for (const std::uint32_t v : already) points.push_back(rules_.mesh.positions[v]);
    }
    for (const std::uint32_t v : vertices(b)) {
        if (std::find(already.begin(), already.end(), v) != already.end()) continue;
        points.push_back(rules_.mesh.positions[v]);
    }
    if (!patches_[a].hull) {
        scope.hull.build(points);
        return;
    }
    scope.hull = *patches_[a].hull;
    for (const Double3& p : points) scope.hull.add(p);
}

bool PatchSet::stays_inside(std::uint32_t a, std::uint32_t b, PatchScope& scope) const {
    if (lie_in_one_plane(a, b)) return is_outline_convex(a, b);
    return hull_stays_inside(a, b, scope);
}

bool PatchSet::hull_stays_inside(std::uint32_t a, std::uint32_t b, PatchScope& scope) const {
    const std::uint64_t size = vertices(a).size() + vertices(b).size();
    const std::uint64_t tests = size * std::min(vertices(a).size(), vertices(b).size());
    if (size > kMostHullVertices || scope.work < tests) return false;
    scope.work -= tests;
    make_hull(a, b, scope);
    const auto is_own = [&](std::uint32_t t) {
        if (t < scope.first || t >= scope.last) return false;
        const std::uint32_t patch = owner_of(t);
        return patch == a || patch == b;
    };
    return rules_.solids.contains(scope.hull, a, is_own, scope.work);
}

bool PatchSet::can_join(std::uint32_t a, std::uint32_t b, PatchScope& scope) const {
    const std::uint64_t tests =
        faces(a).size() * vertices(b).size() + faces(b).size() * vertices(a).size();
    if (scope.work < tests) return false;
    scope.work -= tests;
    if (!fit(a, b, scope)) return false;
    return !rules_.keeps_inside || !rules_.solids.is_solid(a) || stays_inside(a, b, scope);
}

bool PatchSet::is_contained(std::uint32_t patch, PatchScope& scope) const {
    // A triangle, a polygon or a closed patch.
    if (faces(patch).size() == 1) return patches_[patch].closed == Containment::inside;
    if (patches_[patch].is_flat) return is_outline_convex(patch, patch);
    return hull_stays_inside(patch, patch, scope);
}

std::uint32_t PatchSet::join(std::uint32_t a, std::uint32_t b, PatchScope& scope) {
    if (faces(a).size() < faces(b).size()) std::swap(a, b);
    Patch &to = patches_[a], &from = patches_[b];
    to.is_flat = lie_in_one_plane(a, b);
    const auto take = [](std::vector<std::uint32_t>& all, std::span<const std::uint32_t> old,
                         std::span<const std::uint32_t> more) {
        if (all.empty()) all.assign(old.begin(), old.end());
        all.insert(all.end(), more.begin(), more.end());
    };
    const auto old = vertices(a);
    std::vector<std::uint32_t> new_vertices;
    for (const std::uint32_t v : vertices(b)) {
        if (std::find(old.begin(), old.end(), v) == old.end()) new_vertices.push_back(v);
    }
    take(to.faces, faces(a), faces(b));
    take(to.vertices, old, new_vertices);
    const bool has_hull = rules_.keeps_inside && rules_.solids.is_solid(a) && !to.is_flat;
    if (has_hull && to.vertices.size() >= kKeepHullFrom) {
        if (!to.hull) to.hull = std::make_unique<GrowingHull>();
        std::swap(*to.hull, scope.hull);
    }
    from = {};
    parent_[b] = a;
    return a;
}

void PatchSet::join_polygon(std::span<const std::uint32_t> triangles,
                            std::span<const std::uint32_t> corners) {
    close(triangles, Containment::inside);
    Patch& all = patches_[patch_of(triangles[0])];
    all.faces.assign({triangles[0]});
    all.vertices.assign(corners.begin(), corners.end());
}

void PatchSet::close(std::span<const std::uint32_t> triangles, Containment containment) {
    const std::uint32_t patch = *std::min_element(triangles.begin(), triangles.end());
    patches_[patch].closed = containment;
    for (const std::uint32_t t : triangles) parent_[t] = patch;
}

}  // namespace cdprep::convex
