// SPDX-License-Identifier: MIT
#include "cells/corner_cells.h"

#include <algorithm>
#include <array>

#include "cells/cell_contacts.h"
#include "cells/octree_codes.h"
#include "cells/octree_search.h"
#include "cells/potential_set.h"

namespace cdprep {
namespace {

/// The leaf cells of A in which the corners of a triangle of B lie, each once.
struct CornerLeaves {
    std::array<std::uint32_t, 3> node;
    std::size_t count = 0;
};

/// The triangles of a BVH leaf that are listed one after the other from `at` on, which goes
/// behind them.
LeafLanes next_leaf(std::span<const std::uint32_t> listed, std::size_t& at) noexcept {
    const auto triangle = [&] { return listed[at] & ~format::kSharedReference; };
    LeafLanes leaf = {triangle() / format::kBvhWidth, 0};
    for (; at < listed.size() && triangle() / format::kBvhWidth == leaf.leaf; ++at) {
        leaf.lanes |= static_cast<std::uint8_t>(1U << triangle() % format::kBvhWidth);
    }
    return leaf;
}

class CornerCells {
public:
    CornerCells(const Model& a, const Model& b, const Placement& placement,
                CellSearch search) noexcept
        : index_(octree_index(a)),
          search_(search),
          grid_(*a.octree().grid),
          references_(a.octree().references),
          a_from_b_(placement.a_is_moved() ? relative_pose(placement.pose_a(), placement.pose_b())
                                           : placement.pose_b()),
          b_(b, &a_from_b_) {}

    [[nodiscard]] CornerLeaves leaves_of(std::uint32_t at_b) const noexcept {
        CornerLeaves leaves;
        for (const Double3& p : b_.corners(at_b)) {
            const std::uint32_t node = leaf_with(p);
            const auto end = leaves.node.begin() + static_cast<std::ptrdiff_t>(leaves.count);
            if (node != kNoNode && std::find(leaves.node.begin(), end, node) == end) {
                leaves.node[leaves.count++] = node;
            }
        }
        return leaves;
    }
    [[nodiscard]] std::span<const std::uint32_t> references(std::uint32_t node) const noexcept {
        return references_.subspan(index_.nodes[node].first, index_.nodes[node].count);
    }
    /// The number of the first of its leaves that lists a triangle.
    [[nodiscard]] std::size_t first_listing(std::uint32_t at_a, std::uint32_t at_b) const noexcept {
        const CornerLeaves leaves = leaves_of(at_b);
        std::size_t i = 0;
        while (i < leaves.count && !lists(leaves.node[i], at_a)) ++i;
        return i;
    }

private:
    [[nodiscard]] bool lists(std::uint32_t node, std::uint32_t at_a) const noexcept {
        const auto listed = references(node);
        const auto triangle = [](std::uint32_t reference) {
            return reference & ~format::kSharedReference;
        };
        const auto at = std::lower_bound(listed.begin(), listed.end(), at_a,
                                         [&](std::uint32_t reference, std::uint32_t value) {
                                             return triangle(reference) < value;
                                         });
        return at != listed.end() && triangle(*at) == at_a;
    }
    [[nodiscard]] std::uint32_t leaf_with(const Double3& p) const noexcept {
        const auto is_inside = [&](double origin, double x) {
            return x >= origin && x < octree_plane(origin, grid_.step, kOctreeSteps);
        };
        if (!is_inside(grid_.origin.x, p.x) || !is_inside(grid_.origin.y, p.y) ||
            !is_inside(grid_.origin.z, p.z)) {
            return kNoNode;
        }
        return find_leaf(index_, search_, octree_code(octree_cell(grid_, p)));
    }

    OctreeIndex index_;
    CellSearch search_;
    const format::OctreeGrid& grid_;
    std::span<const std::uint32_t> references_;
    Pose a_from_b_;
    MovedModel b_;  ///< among A's cells
};

}  // namespace

bool visit_by_corners(const QuestionThrough& question, ContactVisitor visit) noexcept {
    const Model& b = question.b;
    const PotentialSet potential(question.a, b, question.placement);
    if (potential.is_empty()) return true;
    Workspace::Storage& scratch = question.workspace.storage();
    cells_of(scratch).tested_pairs.begin();
    const CornerCells cells(question.a, b, question.placement, question.through.search);
    const auto found = [&](std::uint32_t at_a, std::uint32_t at_b) { return visit({at_a, at_b}); };
    const auto owns = [&](std::uint64_t place, std::uint32_t at_a, std::uint32_t at_b) {
        return cells.first_listing(at_a, at_b) == place;
    };
    CellContacts contacts(question.a, b, question.placement,
                          place_boxes(question.a, b, question.placement),
                          question.through.leaf_test, question.options, scratch, found, owns);
    const auto look_at = [&](std::uint32_t at_b) {
        const LeafLanes one = {at_b / format::kBvhWidth,
                               static_cast<std::uint8_t>(1U << at_b % format::kBvhWidth)};
        const CornerLeaves leaves = cells.leaves_of(at_b);
        if (scratch.counts != nullptr) {
            ++scratch.counts->potential;
            scratch.counts->cells_sought += 3;
        }
        for (std::size_t i = 0; i < leaves.count; ++i) {
            const auto listed = cells.references(leaves.node[i]);
            if (scratch.counts != nullptr) scratch.counts->references += listed.size();
            for (std::size_t at = 0; at < listed.size();) {
                if (!contacts.add(next_leaf(listed, at), one, i)) return false;
            }
        }
        return true;
    };
    const MovedModel stored(b, nullptr);
    const auto some = [&](const TriangleRun& run) {
        for (std::uint32_t at_b = run.first; at_b < run.last; ++at_b) {
            if (potential.holds(stored.corners(at_b)) && !look_at(at_b)) return false;
        }
        return true;
    };
    const bool whole = walk_nodes(
        b, scratch, [&](const format::BvhNode& node) { return potential.judge(node); }, some,
        [](const TriangleRun& /*run*/) { return true; });
    return whole && contacts.flush();
}

}  // namespace cdprep
