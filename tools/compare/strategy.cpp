// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/strategy.h"

#include <algorithm>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"
#include "cell_searches/literal_octree.h"

namespace cdprep::study {

std::span<const Strategy> strategies() {
    // The table of cells in Ponce Atencio's talk is chained, by the last bits of the key.
    static const std::vector<Strategy> kStrategies = {
        {"tetra-tree", "paper", &ModelForms::paper, {.structure = Structure::tetra_tree}},
        {"octree", "paper", &ModelForms::paper, {.structure = Structure::octree}},
        {"hashed octree",
         "paper",
         &ModelForms::paper,
         {.structure = Structure::hashed_octree, .search = CellSearch::modulus}},
        {"hashed octree, literal",
         "paper",
         &ModelForms::paper,
         {.structure = Structure::hashed_octree, .search = CellSearch::modulus},
         false,
         true},
        {"tetra-tree", "tuned", &ModelForms::tuned, {.structure = Structure::tetra_tree}},
        {"octree", "tuned", &ModelForms::tuned, {.structure = Structure::octree}},
        {"hashed octree",
         "tuned",
         &ModelForms::tuned_hashed,
         {.structure = Structure::hashed_octree}},
        {"PQP-style BVH", "", &ModelForms::swept, {.structure = Structure::bvh}},
        {"SWIFT++-style pieces", "", &ModelForms::plain, {.structure = Structure::pieces}},
        {"GJK on hulls", "", &ModelForms::plain, {}, true},
        {"exact BVH", "", &ModelForms::plain, {.structure = Structure::bvh}},
    };
    return kStrategies;
}

StrategyPair::StrategyPair(const Strategy& strategy, const ModelForms& a, const ModelForms& b)
    : strategy_(strategy),
      a_((a.*strategy.form).model),
      b_((b.*strategy.form).model),
      pairs_(std::size_t{1} << 16) {
    if (!strategy.of_hulls || !a_.serves(Ask::hulls) || !b_.serves(Ask::hulls)) return;
    const auto hull_a = find_hull(a_, format::HullScope::whole);
    const auto hull_b = find_hull(b_, format::HullScope::whole);
    if (!hull_a || !hull_b) return;
    hull_a_ = convex_points(a_, *hull_a);
    hull_b_ = convex_points(b_, *hull_b);
}

std::string StrategyPair::find_reason(Asked asked) const {
    const Structure structure = strategy_.through.structure;
    if (strategy_.of_hulls) {
        if (asked == Asked::overlap) return "a hull has no triangles of the mesh";
        if (asked == Asked::contacts) return "supported by pieces only";
        return hull_a_ && hull_b_ ? "" : "a model has no hull";
    }
    if (asked == Asked::contacts && structure != Structure::pieces)
        return "supported by pieces only";
    const bool measures = structure == Structure::bvh || structure == Structure::pieces;
    if ((asked == Asked::distance || asked == Asked::within) && !measures) {
        return "cells do not bound distances";
    }
    return "";
}

bool StrategyPair::collides(const Placement& placement) {
    if (strategy_.of_hulls) return convex_collide(*hull_a_, *hull_b_, placement);
    if (strategy_.is_literal) {
        bool hit = false;
        const auto end = [&](const TrianglePair&) { return !(hit = true); };
        visit_literally(placement, end);
        return hit;
    }
    return any_overlap_through({a_, b_, placement}, strategy_.through, workspace_);
}

void StrategyPair::visit_literally(const Placement& placement, PairVisitor keep) {
    visit_literal_overlaps(a_, b_, placement,
                           {.search = strategy_.through.search, .counts = counts_}, keep);
}

std::size_t StrategyPair::count_pairs(const Placement& placement) {
    if (strategy_.is_literal) {
        std::size_t count = 0;
        const auto keep = [&](const TrianglePair& pair) {
            if (count < pairs_.size()) pairs_[count] = pair;
            ++count;
            return true;
        };
        visit_literally(placement, keep);
        std::sort(pairs_.begin(),
                  pairs_.begin() + static_cast<std::ptrdiff_t>(std::min(count, pairs_.size())));
        return count;
    }
    return overlaps_through({a_, b_, placement}, strategy_.through, workspace_, pairs_);
}

std::span<const TrianglePair> StrategyPair::pairs(const Placement& placement) {
    std::size_t count = count_pairs(placement);
    if (count > pairs_.size()) {
        pairs_.resize(count);
        count = count_pairs(placement);
    }
    return std::span(pairs_).first(count);
}

Gap StrategyPair::gap(const Placement& placement) {
    if (strategy_.of_hulls) {
        const auto found = convex_distance(*hull_a_, *hull_b_, placement);
        return {found->lower, found->upper};
    }
    const auto found =
        distance({a_, b_, placement, {.through = strategy_.through.structure}}, workspace_);
    return found ? Gap{found->lower, found->upper} : Gap{};
}

bool StrategyPair::is_within(const Placement& placement, double tolerance) {
    if (strategy_.of_hulls) return convex_within(*hull_a_, *hull_b_, placement, tolerance);
    return within({a_, b_, placement, {.through = strategy_.through.structure}}, tolerance,
                  workspace_);
}

std::size_t StrategyPair::contacts(const Placement& placement, double tolerance,
                                   std::span<Contact> room) {
    return cdprep::contacts({a_, b_, placement}, workspace_, room, {.tolerance = tolerance}).found;
}

}  // namespace cdprep::study
