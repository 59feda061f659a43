// SPDX-License-Identifier: MIT
#include "cells/inclusion_by_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "cells/adaptive_octree_tree.h"
#include "cells/octree_codes.h"
#include "cells/octree_tree.h"
#include "cells/tetra_cones.h"
#include "core/moved_model.h"
#include "core/numbers.h"
#include "exact/predicates.h"
#include "exact/winding.h"
#include "walk/box_placement.h"
#include "walk/workspace_storage.h"

// The winding number is the sum of winding_term() over any sufficient list of triangles. Such a
// list holds exactly once each triangle with a term other than 0. It must also hold every triangle
// that q lies on. Let R be the closed ray from q away from the origin o. Rays from q arbitrarily
// near to R meet a triangle whose term is not 0. The points where they meet it are bounded because
// the triangle is. These points accumulate at a point of R, and the triangle, being closed, holds
// it. So a list is sufficient if it holds each triangle that touches R once. Of these, only those
// whose box meets that of R are tested further. The symbolic perturbation of o requires no other
// neighbours.
//
// Tetra-tree: o is the centre C, and R = {C + s (q - C), s >= 1}. All points of R have one
// direction from C, so R lies in one cone, borders or not. A triangle that touches R touches that
// closed cone. So it is in its leaf's list, or it holds C. If it holds C and touches R, it holds
// all points between, q among them. Those triangles need not be counted, but they must be tested. A
// cone without a node touches none of the other triangles. From q = C the ray may run anywhere. It
// runs along +x, an edge of the cone of the least key.
//
// Octrees: R runs along +x, because o is q moved back along x alone. The planes of the leaves that
// R runs through cut it into intervals x0 < x <= x1. The first and the last interval are unbounded.
// A triangle with a term other than 0 has q outside its plane. That plane is not parallel to x:
// otherwise only unbounded points would be met. So it has one point h on R, and counts only in the
// leaf whose interval has h. The leaf's closed cell touches the triangle at h, so the leaf lists
// it. orient3d() compares h with x0 and x1.

namespace cdprep {
namespace {

/// Returns MovedBoxes::reach() for a model that is not moved; never 0.
double reach_of(const Model& model) noexcept {
    const format::FileHeader& header = model.header();
    const Double3& o = header.frame_origin;
    return std::max({std::fabs(o.x), std::fabs(o.y), std::fabs(o.z)}) +
           std::ldexp(1.0, -header.frame_exponent);
}

/// Returns the box around the ray from q away from o. Along each axis it has no extent, or is
/// unbounded on one side.
Box3 box_of_ray(const Double3& o, const Double3& q) noexcept {
    return {
        {q.x < o.x ? -kInfinity : q.x, q.y < o.y ? -kInfinity : q.y, q.z < o.z ? -kInfinity : q.z},
        {q.x > o.x ? kInfinity : q.x, q.y > o.y ? kInfinity : q.y, q.z > o.z ? kInfinity : q.z}};
}

/// An interval of a ray along x: x0 < x <= x1; either may be infinite.
struct Interval {
    double x0 = -std::numeric_limits<double>::infinity();
    double x1 = std::numeric_limits<double>::infinity();
};

/// The sum of the crossings of the ray from q away from o.
class Crossings {
public:
    Crossings(const Model& model, const Double3& o, const Double3& q, QueryCounts* counts) noexcept
        : model_(model, nullptr), o_(o), q_(q), ray_(box_of_ray(o, q)), counts_(counts) {}

    /// Adds all crossings with a triangle. Returns false when q lies on it, which ends the search.
    bool add(std::uint32_t triangle) noexcept {
        return add(triangle, [](const Corners&, int) { return true; });
    }

    /// Adds the crossings with a leaf's references. Shared ones count only in their own interval of
    /// the ray, which must run along +x.
    bool add(std::span<const std::uint32_t> references, const Interval& interval) noexcept {
        for (const std::uint32_t reference : references) {
            const bool shared = (reference & format::kSharedReference) != 0;
            const auto counts_here = [&](const Corners& t, int crossings) {
                return !shared || is_in(interval, t, crossings);
            };
            if (!add(reference & ~format::kSharedReference, counts_here)) return false;
        }
        return true;
    }

    [[nodiscard]] Inclusion inclusion() const noexcept {
        if (on_surface_) return {Answer::yes, true, 0};
        return {winding_ != 0 ? Answer::yes : Answer::no, false, static_cast<double>(winding_)};
    }

private:
    template <class CountsHere>
    bool add(std::uint32_t triangle, CountsHere&& counts_here) noexcept {
        if (counts_ != nullptr) ++counts_->ray_triangles;
        const Corners t = model_.corners(triangle);
        if (!overlap(box_around(t), ray_)) return true;  // it does not touch R: see above
        const WindingTerm term = winding_term(o_, q_, t);
        on_surface_ = term.on_surface;
        if (term.crossings != 0 && counts_here(t, term.crossings)) winding_ += term.crossings;
        return !on_surface_;
    }

    /// Returns whether a crossing is in an interval. `crossings` is the side of the plane that the
    /// ray comes from. The plane is ahead as long as the ray is on that side.
    [[nodiscard]] bool is_in(const Interval& interval, const Corners& t,
                             int crossings) const noexcept {
        const auto is_ahead_at = [&](double x) {
            return orient3d(t[0], t[1], t[2], {x, q_.y, q_.z}) == crossings;
        };
        return (std::isinf(interval.x0) || is_ahead_at(interval.x0)) &&
               (std::isinf(interval.x1) || !is_ahead_at(interval.x1));
    }

    MovedModel model_;
    Double3 o_;
    Double3 q_;
    Box3 ray_;
    QueryCounts* counts_;  ///< or null
    long winding_ = 0;
    bool on_surface_ = false;
};

/// Returns the references of a leaf.
template <class Node>
std::span<const std::uint32_t> listed(std::span<const std::uint32_t> references,
                                      const Node& leaf) noexcept {
    return references.subspan(leaf.first, leaf.count);
}

/// Returns the leaf that holds the cone of a key of the deepest level, or null.
const format::TetraNode* find_leaf(const Model& model, std::uint32_t key) noexcept {
    const format::TetraTree& tree = *model.tetra_tree().tree;
    assert(format::tetra_level(key) == tree.level);
    const std::uint32_t top_key = key >> (2 * (tree.level - tree.top_level));
    const std::uint32_t entry = model.tetra_tree().top[top_key - (8U << (2 * tree.top_level))];
    if (entry == 0) return nullptr;
    const format::TetraNode* node = &model.tetra_tree().nodes[entry - 1];
    for (std::uint32_t level = tetra_level(node->key);
         (node->flags & format::tetra_inner) != 0 && level < tree.level; ++level) {
        const std::uint32_t child = (key >> (2 * (tree.level - level - 1))) & 3;
        const std::uint32_t mask = node->flags & format::tetra_children;
        if ((mask >> child & 1) == 0) return nullptr;
        node = &model.tetra_tree().nodes[node->first + lanes_before(mask, child)];
    }
    return node;
}

/// Returns whether q is farther out along its octant's axis than anything in the leaf. Then the
/// ray, which leads even farther, meets nothing in it. A difference, two sums, the quotient, its
/// root and the product are each off by u at most: 6 u, and 2^-50 is 8 u. Scaling comes first, so
/// that nothing else is rounded below 2^-1022. Scaling may itself round there, which only matters
/// for a leaf of radius 0: one with triangles at C alone, which are in no list.
bool is_beyond(const format::TetraNode& leaf, const Model& model, const Double3& q) noexcept {
    constexpr double kRootOfThree = 1.7320508075688772;
    const Double3& c = model.tetra_tree().tree->centre;
    const auto apart = [&](double a, double b) {
        return scaled(std::fabs(a - b), model.header().frame_exponent);
    };
    const double far = (apart(q.x, c.x) + apart(q.y, c.y) + apart(q.z, c.z)) / kRootOfThree;
    return far * (1 - 0x1p-50) > leaf.radius_max;
}

Inclusion through_tetra_tree(const Model& model, const Double3& q, QueryCounts* counts) noexcept {
    const format::TetraTree& tree = *model.tetra_tree().tree;
    const bool at_centre = q == tree.centre;
    Crossings crossings(model, at_centre ? before_along_x(q, reach_of(model)) : tree.centre, q,
                        counts);
    for (const std::uint32_t t : model.tetra_tree().references.first(tree.centre_count)) {
        if (!crossings.add(t & ~format::kSharedReference)) return crossings.inclusion();
    }
    const std::uint32_t least = 8U << (2 * tree.level);
    const std::uint32_t key = at_centre ? least : tetra_key(tree.centre, q, tree.level);
    const format::TetraNode* leaf = find_leaf(model, key);
    if (leaf == nullptr || is_beyond(*leaf, model, q)) return crossings.inclusion();
    for (const std::uint32_t t : listed(model.tetra_tree().references, *leaf)) {
        if (!crossings.add(t & ~format::kSharedReference)) break;
    }
    return crossings.inclusion();
}

/// Adds the crossings in the leaves along the ray, nearest first. On the plane between two cells
/// side by side in y or z, the ray is in the lower one. Either cell lists what touches that plane,
/// and an axis that is not divided has only the lower one.
template <class Tree>
void walk_row(const Tree& tree, const Double3& q, Crossings& crossings) noexcept {
    struct OpenCell {
        typename Tree::Cell cell;
        Interval interval;
    };
    std::array<OpenCell, Tree::kMostLevels> open;  // each level down adds one
    std::size_t depth = 0;
    open[depth++] = {tree.child(tree.top(), 0), {}};
    while (depth > 0) {
        const auto [cell, interval] = open[--depth];
        if (interval.x1 < q.x) continue;
        if (tree.is_leaf(cell)) {
            if (!crossings.add(tree.references(cell), interval)) return;
            continue;
        }
        const Double3 split = tree.split(cell);
        const unsigned row = (q.y > split.y ? 2U : 0U) | (q.z > split.z ? 4U : 0U);
        const unsigned lanes = tree.lanes(cell);
        assert(depth + static_cast<unsigned>(std::popcount(lanes >> row & 3)) <= open.size());
        if ((lanes >> row >> 1 & 1) != 0) {
            open[depth++] = {tree.child(cell, row | 1), {split.x, interval.x1}};
        }
        if ((lanes >> row & 1) != 0)
            open[depth++] = {tree.child(cell, row), {interval.x0, split.x}};
    }
}

template <class Tree>
Inclusion through_cells(const Tree& tree, const Model& model, const Double3& q,
                        QueryCounts* counts) noexcept {
    if (!holds(tree.box(tree.top()), q)) return {};
    Crossings crossings(model, before_along_x(q, reach_of(model)), q, counts);
    walk_row(tree, q, crossings);
    return crossings.inclusion();
}

/// Returns the level of the largest cell that holds one finest cell and not the other.
std::uint32_t level_between(std::uint64_t code, std::uint64_t other) noexcept {
    assert(code != other);
    const auto differ = static_cast<std::uint32_t>(std::bit_width(code ^ other) - 1);
    return format::kOctreeBits - differ / 3;
}

/// One cell along the ray: a leaf, or an empty one.
struct FoundCell {
    const format::OctreeNode* leaf;  ///< or null
    std::uint32_t level;
};

/// Returns the leaf that holds a finest cell, or the largest cell there that no leaf overlaps. The
/// leaves before and after it along the Z-order curve are the nearest.
FoundCell find_cell(const Model& model, std::uint64_t code) noexcept {
    const auto codes = model.octree().leaf_codes;
    const auto top = model.octree().top;
    const std::uint64_t cell = code >> (3 * (format::kOctreeBits - model.octree().grid->top_level));
    assert(cell + 1 < top.size());
    const auto behind =
        std::upper_bound(codes.begin() + top[cell], codes.begin() + top[cell + 1], code);
    std::uint32_t empty = 0;
    if (behind != codes.begin()) {
        const auto index = static_cast<std::size_t>(behind - codes.begin()) - 1;
        const format::OctreeNode& leaf = model.octree().nodes[model.octree().leaf_nodes[index]];
        const std::uint32_t level = std::min(level_of(leaf.key), format::kOctreeBits);
        if (code - codes[index] < cells_below(level)) return {&leaf, level};
        empty = level_between(code, codes[index]);
    }
    if (behind != codes.end()) empty = std::max(empty, level_between(code, *behind));
    return {nullptr, empty};
}

Inclusion through_keys(const Model& model, const Double3& q, QueryCounts* counts) noexcept {
    const format::OctreeGrid& grid = *model.octree().grid;
    if (!holds(octree_box(grid, {0, 0, 0}, 0), q)) return {};
    Crossings crossings(model, before_along_x(q, reach_of(model)), q, counts);
    CellPlace place = octree_cell(grid, q);
    while (place[0] < kOctreeSteps) {
        const FoundCell cell = find_cell(model, octree_code(place));
        const std::uint32_t steps = kOctreeSteps >> cell.level;
        const std::uint32_t first = place[0] & ~(steps - 1);
        place[0] = first + steps;
        if (cell.leaf == nullptr) continue;
        const Interval interval = {octree_plane(grid.origin.x, grid.step, first),
                                   octree_plane(grid.origin.x, grid.step, place[0])};
        if (!crossings.add(listed(model.octree().references, *cell.leaf), interval)) break;
    }
    return crossings.inclusion();
}

}  // namespace

Inclusion inclusion_by_cells(const Model& model, const Double3& p, Workspace& workspace,
                             Structure through) noexcept {
    QueryCounts* counts = workspace.storage().counts;
    switch (through) {
        case Structure::tetra_tree:
            return through_tetra_tree(model, p, counts);
        case Structure::octree:
            return through_cells(OctreeTree(model), model, p, counts);
        case Structure::adaptive_octree:
            return through_cells(AdaptiveOctreeTree(model), model, p, counts);
        default:
            return through_keys(model, p, counts);
    }
}

}  // namespace cdprep
