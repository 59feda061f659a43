// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/pairs.h"
#include "core/triangle_facts.h"
#include "exact/triangle_contact.h"
#include "walk/find_contact.h"
#include "walk/leaf_batch.h"
#include "walk/walked_trees.h"

namespace cdprep {

/// Decides exactly whether one pair of triangles is in contact. Most touching pairs are neighbours
/// in one mesh; a common corner proves their contact.
inline bool in_contact(const Corners& a, const Corners& b, Overlap overlap,
                       QueryCounts* counts) noexcept {
    if (overlap == Overlap::closed && share_a_corner(a, b)) {
        if (counts != nullptr) ++counts->by_corner;
        return true;
    }
    const std::optional<TriangleContact> sure = contact_by_filter(a, b);
    if (counts != nullptr) ++(sure ? counts->by_filter : counts->by_exact);
    const TriangleContact kind = sure ? *sure : contact_beyond_filter(a, b);
    if (overlap == Overlap::closed) return kind != TriangleContact::disjoint;
    return kind == TriangleContact::cross || kind == TriangleContact::coplanar_overlap;
}

/// Decides whether a pair of triangles that the kernels report is in contact, as the options define
/// it. Tree order.
class ContactTest {
public:
    ContactTest(const Model& a, const Model& b, const Placement& placement,
                const PairOptions& options, QueryCounts* counts) noexcept
        : ContactTest(moved_a(a, placement), moved_b(b, placement), options, counts) {}
    ContactTest(const MovedModel& a, const MovedModel& b, const PairOptions& options,
                QueryCounts* counts) noexcept
        : a_(a), b_(b), options_(options), counts_(counts) {}

    bool operator()(std::uint32_t at_a, std::uint32_t at_b, bool certain) const noexcept {
        if (skips(at_a, at_b)) return false;
        if (!certain) {
            return in_contact(a_.corners(at_a), b_.corners(at_b), options_.overlap, counts_);
        }
        if (counts_ != nullptr) ++counts_->by_kernel;
        return true;
    }

    /// Returns whether the options exclude the pair from all answers.
    [[nodiscard]] bool skips(std::uint32_t at_a, std::uint32_t at_b) const noexcept {
        return options_.degenerate == Degenerate::skip &&
               (is_marked_degenerate(*a_.model, at_a) || is_marked_degenerate(*b_.model, at_b));
    }

private:
    MovedModel a_;
    MovedModel b_;
    PairOptions options_;
    QueryCounts* counts_;  ///< or null
};

/// Calls `found(a, b)`, tree order, for every pair of triangles in contact. Stops and returns false
/// when `found` returns false.
template <Search kSearch, class Trees = TriangleTrees, class Found>
bool for_each_contact(const Model& a, const Model& b, const Placement& placement,
                      Workspace& workspace, const PairOptions& options, Found&& found) noexcept {
    Workspace::Storage& scratch = workspace.storage();
    // Most models that do not touch are separated before any leaf is reached.
    std::optional<ContactTest> touch;
    std::optional<LeafBatch> batch;
    const Trees trees(a, b, scratch);
    const auto decide = [&](std::uint32_t at_a, std::uint32_t at_b, bool certain) {
        if (!touch) touch.emplace(a, b, placement, options, scratch.counts);
        at_a = trees.triangle_a(at_a);
        at_b = trees.triangle_b(at_b);
        return !(*touch)(at_a, at_b, certain) || static_cast<bool>(found(at_a, at_b));
    };
    const PlacedBoxes placed = place_boxes(a, b, placement);
    const auto add = [&](const LeafView& in_a, const LeafView& in_b) {
        batch->add(in_a, in_b);
        return !batch->full() || batch->flush(decide);
    };
    const bool whole = walk_pairs<kSearch>(
        trees.a, trees.b, placed, scratch, [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
            if (!batch) batch.emplace(a, b, placed, scratch);
            return trees.each_pair(*batch, leaf_a, leaf_b, add) &&
                   (kSearch == Search::all || batch->flush(decide));
        });
    return whole && (!batch || batch->flush(decide));
}

/// Returns the first pair of triangles in contact that a walk meets.
template <class Trees>
std::optional<TreePair> find_contact_by(const Model& a, const Model& b, const Placement& placement,
                                        Workspace& workspace, const PairOptions& options) noexcept {
    std::optional<TreePair> contact;
    for_each_contact<Search::first, Trees>(a, b, placement, workspace, options,
                                           [&](std::uint32_t at_a, std::uint32_t at_b) {
                                               contact = TreePair{at_a, at_b};
                                               return false;
                                           });
    return contact;
}

}  // namespace cdprep
