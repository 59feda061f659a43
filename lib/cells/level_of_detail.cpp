// SPDX-License-Identifier: MIT
#include "cdprep/cells/level_of_detail.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

#include "cdprep/format/float_environment.h"
#include "cells/tetra_tree_cells.h"
#include "cells/walk_cells.h"
#include "core/moved_model.h"
#include "core/moved_point.h"
#include "core/require.h"
#include "walk/cell_searches.h"

// A solid lies below the outer facets of its cones: a ray from the centre leaves it for good at its
// last triangle. If it is balanced and its centre is inside, it contains everything below the inner
// facets: no triangle lies between the centre and them. Points are placed and compared in double.
// Radii are corrected for the rounding of points: kSlack times the sizes involved. Rotations are
// orthogonal to 1e-12; all other errors are far smaller.

namespace cdprep {
namespace {

using format::TetraNode;

constexpr double kSlack = 0x1p-36;
constexpr double kRoot3 = 1.7320508075688773;

/// The cones of a level, and those above it that are not split.
class Facets {
public:
    Facets(const Model& model, std::uint32_t level) noexcept
        : nodes_(model.tetra_tree().nodes),
          level_(std::min(level, model.tetra_tree().tree->level)),
          frame_unit_(std::ldexp(1.0, -model.header().frame_exponent)) {}

    [[nodiscard]] std::uint32_t level() const noexcept {
        return level_;
    }
    [[nodiscard]] double inner(const TetraNode& node) const noexcept {
        return node.radius_min * frame_unit_;
    }
    [[nodiscard]] double outer(const TetraNode& node) const noexcept {
        return node.radius_max * frame_unit_;
    }

    /// Calls visit(node) until it returns true; returns whether it did.
    template <class Visit>
    bool any(Visit&& visit) const noexcept {
        for (const TetraNode& node : nodes_) {
            const std::uint32_t level = format::tetra_level(node.key);
            if (level > level_) break;
            const bool is_split = (node.flags & format::tetra_inner) != 0;
            if (is_split && level < level_) continue;
            if (visit(node)) return true;
        }
        return false;
    }

    /// Returns the cone that contains a cone of the level, or null: no triangle is there.
    [[nodiscard]] const TetraNode* find(std::uint32_t key) const noexcept {
        for (; key >= 8; key >>= 2) {
            const auto at = std::lower_bound(
                nodes_.begin(), nodes_.end(), key,
                [](const TetraNode& node, std::uint32_t k) { return node.key < k; });
            if (at != nodes_.end() && at->key == key) return &*at;
        }
        return nullptr;
    }

private:
    std::span<const TetraNode> nodes_;
    std::uint32_t level_;
    double frame_unit_;
};

/// A solid that certainly contains everything below its inner facets, and its pose.
class Core {
public:
    Core(const Model& model, const Pose& pose, const Facets& facets) noexcept
        : model_(model), tree_(*model.tetra_tree().tree), pose_(pose), facets_(facets) {
        const Double3& c = tree_.centre;
        const Double3& t = pose.translation();
        size_ = std::max({std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)}) +
                std::ldexp(2.0, -model.header().frame_exponent);
        reach_ = size_ + std::max({std::fabs(t.x), std::fabs(t.y), std::fabs(t.z)});
    }

    /// Returns whether the inside is certain.
    [[nodiscard]] bool is_certain() const noexcept {
        return model_.is_balanced() && (tree_.flags & format::tetra_centre_inside) != 0 &&
               tree_.centre_count == 0;
    }

    /// Calls visit(p) for points of the inside, as moved, until it returns true. Returns whether it
    /// did.
    template <class Visit>
    bool any_point(Visit&& visit) const noexcept {
        if (visit(moved_point(pose_, tree_.centre))) return true;
        return facets_.any([&](const TetraNode& node) {
            // Below the facet by more than a point may be off.
            const double inner = facets_.inner(node) * (1 - 0x1p-8);
            return facets_.inner(node) - inner > 2 * kSlack * reach_ &&
                   any_below_facet(tetra_cone(node.key), inner * kRoot3, visit);
        });
    }

    /// Returns whether p, a moved point, is certainly inside. `reach` is the sizes of everything
    /// that p was computed from.
    [[nodiscard]] bool holds(const Double3& p, double reach) const noexcept {
        const Double3 own = back(p);
        const double slack = kSlack * (reach + reach_);
        const Double3 d = {own.x - tree_.centre.x, own.y - tree_.centre.y, own.z - tree_.centre.z};
        // A point this near to a coordinate plane may be in several octants. It is not worth a
        // search of all their cones.
        if (std::fabs(d.x) <= slack || std::fabs(d.y) <= slack || std::fabs(d.z) <= slack) {
            return false;
        }
        const TetraNode* node = facets_.find(tetra_key(tree_.centre, own, facets_.level()));
        if (node == nullptr) return false;
        const double height = (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z)) / kRoot3;
        return is_well_inside(*node, d, slack) && height + 2 * slack < facets_.inner(*node);
    }

    [[nodiscard]] double reach() const noexcept {
        return reach_;
    }

private:
    template <class Visit>
    bool any_below_facet(const TetraCone& cone, double radius, Visit& visit) const noexcept {
        assert(cone.level <= format::kMaxTetraLevel);
        const double factor = radius / (1U << cone.level);
        Double3 sum = {0, 0, 0};
        for (const Generator& g : cone.generator) {
            sum = {sum.x + g[0] * factor, sum.y + g[1] * factor, sum.z + g[2] * factor};
        }
        for (const double share : {1.0, 0.5}) {
            const Double3 p = {tree_.centre.x + sum.x * (share / 3),
                               tree_.centre.y + sum.y * (share / 3),
                               tree_.centre.z + sum.z * (share / 3)};
            if (visit(moved_point(pose_, p))) return true;
        }
        return false;
    }

    /// Returns whether all points within `slack` of the direction lie in the node's cone: its three
    /// faces are farther away.
    [[nodiscard]] static bool is_well_inside(const TetraNode& node, const Double3& d,
                                             double slack) noexcept {
        const TetraCone cone = tetra_cone(node.key);
        for (std::size_t i = 0; i < 3; ++i) {
            const Generator& u = cone.generator[i];
            const Generator& v = cone.generator[(i + 1) % 3];
            const std::array<double, 3> n = {double(u[1]) * v[2] - double(u[2]) * v[1],
                                             double(u[2]) * v[0] - double(u[0]) * v[2],
                                             double(u[0]) * v[1] - double(u[1]) * v[0]};
            const double above = n[0] * d.x + n[1] * d.y + n[2] * d.z;
            const double size = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
            if (!(std::fabs(above) > 2 * size * slack)) return false;
        }
        return true;
    }

    /// Maps a moved point to the model's own coordinates, by the pose's transpose.
    [[nodiscard]] Double3 back(const Double3& p) const noexcept {
        const std::array<double, 9>& r = pose_.rotation();
        const Double3& t = pose_.translation();
        const Double3 d = {p.x - t.x, p.y - t.y, p.z - t.z};
        return {r[0] * d.x + r[3] * d.y + r[6] * d.z, r[1] * d.x + r[4] * d.y + r[7] * d.z,
                r[2] * d.x + r[5] * d.y + r[8] * d.z};
    }

    const Model& model_;
    const format::TetraTree& tree_;
    Pose pose_;
    const Facets& facets_;
    double size_ = 0;
    double reach_ = 0;
};

/// Returns whether the cones of a level of each model, cut off at their outer facets, may meet.
bool may_meet(const Model& a, const Model& b, const Placement& placement,
              const std::array<std::uint32_t, 2>& levels, Workspace::Storage& scratch) noexcept {
    const PlacedBoxes placed = place_boxes(a, b, placement);
    if (placed.apart) return false;
    // A triangle at a centre is below no facet.
    if (a.tetra_tree().tree->centre_count > 0 || b.tetra_tree().tree->centre_count > 0) return true;
    const TetraTreeCells in_a(a, {levels[0], true});
    const TetraTreeCells in_b(b, {levels[1], true});
    if (in_a.is_empty() || in_b.is_empty()) return false;
    CellWalk<Search::first, TetraTreeCells, TetraTreeCells, AllLanes> walk(
        in_a, in_b, placed, Descent::larger, AllLanes{});
    walk.use(scratch);
    return !walk.run([](const auto& /*pair*/, const CellBounds& /*a*/, const CellBounds& /*b*/) {
        return false;
    });
}

}  // namespace

double level_error(const Model& model, std::uint32_t level) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::tetra_tree);
    if (model.triangle_count() == 0) return 0;
    const Facets facets(model, level);
    double widest = 0;
    facets.any([&](const TetraNode& node) {
        widest = std::max(widest, facets.outer(node) - facets.inner(node));
        return false;
    });
    // A ray is at most this oblique to its octant's normal. Two roundings are included.
    return widest * kRoot3 * (1 + 0x1p-50);
}

CoarseCollision collide_at_level(const Pair& pair, std::uint32_t level,
                                 Workspace& workspace) noexcept {
    const Model &a = pair.a, &b = pair.b;
    const Placement& placement = pair.placement;
    const format::FloatEnvironment environment;
    require(a, b, Ask::tetra_tree);
    static_cast<void>(require_cells(workspace));
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return {Answer::no, 0, 0};
    CoarseCollision result{Answer::unknown, level_error(a, level), level_error(b, level)};
    const Facets facets_a(a, level);
    const Facets facets_b(b, level);
    if (!may_meet(a, b, placement, {facets_a.level(), facets_b.level()}, workspace.storage())) {
        result.answer = Answer::no;
        return result;
    }
    const Core core_a(a, placement.pose_a(), facets_a);
    const Core core_b(b, placement.pose_b(), facets_b);
    if (!core_a.is_certain() || !core_b.is_certain()) return result;
    const bool meet =
        core_a.any_point([&](const Double3& p) { return core_b.holds(p, core_a.reach()); }) ||
        core_b.any_point([&](const Double3& p) { return core_a.holds(p, core_b.reach()); });
    if (meet) result.answer = Answer::yes;
    return result;
}

}  // namespace cdprep
