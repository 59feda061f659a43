// SPDX-License-Identifier: GPL-3.0-or-later
#include "cell_searches/literal_octree.h"

#include <algorithm>
#include <vector>

#include "cdprep/cells/octree_search.h"
#include "cdprep/exact/triangles.h"
#include "cdprep/format/float_environment.h"
#include "cell_searches/potential_set.h"

namespace cdprep::study {
namespace {

std::uint32_t source_number(const Model& model, std::uint32_t triangle) {
    const auto source = model.source().triangle;
    return source.empty() ? triangle : source[triangle];
}

bool boxes_meet(const Corners& s, const Corners& t) {
    for (double Double3::*x : {&Double3::x, &Double3::y, &Double3::z}) {
        const auto [s_low, s_high] = std::minmax({s[0].*x, s[1].*x, s[2].*x});
        const auto [t_low, t_high] = std::minmax({t[0].*x, t[1].*x, t[2].*x});
        if (s_high < t_low || t_high < s_low) return false;
    }
    return true;
}

bool overlap_as(const Corners& s, const Corners& t, Overlap overlap) {
    if (!boxes_meet(s, t)) return false;
    if (overlap == Overlap::closed) return exact::triangles_touch(s, t);
    const TriangleContact contact = exact::classify_contact(s, t);
    return contact == TriangleContact::cross || contact == TriangleContact::coplanar_overlap;
}

/// The triangles of A that its cells list at the corners of B's triangles.
class CornerCells {
public:
    CornerCells(const Model& a, CellSearch search)
        : index_(octree_index(a)),
          search_(search),
          grid_(*a.octree().grid),
          references_(a.octree().references) {}

    /// Returns the triangles of A, ascending, in the leaf cells of three points of its frame.
    [[nodiscard]] const std::vector<std::uint32_t>& listed(const Corners& points,
                                                           QueryCounts& counts) {
        listed_.clear();
        for (const Double3& p : points) {
            ++counts.cells_sought;
            if (!is_inside(p)) continue;
            const std::uint32_t leaf = find_leaf(index_, search_, code_of_point(grid_, p));
            if (leaf == kNoNode) continue;
            const format::OctreeNode& node = index_.nodes[leaf];
            counts.references += node.count;
            for (const std::uint32_t reference : references_.subspan(node.first, node.count)) {
                listed_.push_back(reference & ~format::kSharedReference);
            }
        }
        std::ranges::sort(listed_);
        listed_.erase(std::unique(listed_.begin(), listed_.end()), listed_.end());
        return listed_;
    }

private:
    /// Returns true if the half-open cube of the octree contains p.
    [[nodiscard]] bool is_inside(const Double3& p) const {
        constexpr double kSteps = 1U << format::kOctreeBits;
        const auto is_between = [&](double origin, double x) {
            return x >= origin && x < origin + kSteps * grid_.step;
        };
        return is_between(grid_.origin.x, p.x) && is_between(grid_.origin.y, p.y) &&
               is_between(grid_.origin.z, p.z);
    }

    OctreeIndex index_;
    CellSearch search_;
    const format::OctreeGrid& grid_;
    std::span<const std::uint32_t> references_;
    std::vector<std::uint32_t> listed_;
};

}  // namespace

bool visit_literal_overlaps(const Model& a, const Model& b, const Placement& placement,
                            const LiteralOptions& options, PairVisitor visit) {
    const format::FloatEnvironment environment;
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return true;
    QueryCounts ignored;
    QueryCounts& counts = options.counts != nullptr ? *options.counts : ignored;
    const PotentialSet potential(a, b, placement);
    const Pose a_from_b = a_from_b_of(placement);
    CornerCells cells(a, options.search);
    const auto is_left_out = [&](const Corners& t) {
        return options.degenerate == Degenerate::skip && exact::is_degenerate(t);
    };
    for (std::uint32_t at_b = 0; at_b < b.triangle_count(); ++at_b) {
        const Corners stored = stored_corners(b.mesh(), at_b);
        if (!potential.holds(stored) || is_left_out(stored)) continue;
        ++counts.potential;
        const Corners in_b = placement.b_is_moved() ? moved(stored, placement.pose_b()) : stored;
        for (const std::uint32_t at_a : cells.listed(moved(stored, a_from_b), counts)) {
            const Corners of_a = stored_corners(a.mesh(), at_a);
            const Corners in_a = placement.a_is_moved() ? moved(of_a, placement.pose_a()) : of_a;
            ++counts.triangle_pairs;
            if (is_left_out(of_a) || !overlap_as(in_a, in_b, options.overlap)) continue;
            if (!visit({source_number(a, at_a), source_number(b, at_b)})) return false;
        }
    }
    return true;
}

}  // namespace cdprep::study
