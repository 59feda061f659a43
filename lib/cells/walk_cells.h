// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>

#include "cdprep/cells/overlap_through.h"
#include "cells/cell_storage.h"
#include "walk/walk_pairs.h"

namespace cdprep {

/// Some children of a node.
template <class Cell>
struct SomeChildren {
    Cell parent;
    unsigned lanes;  ///< bit set
};

/// Two leaf cells, by their parents and their lanes among the children.
template <class CellA, class CellB>
struct CellPair {
    CellA a;
    CellB b;
    unsigned lane_a;
    unsigned lane_b;
};

/// The lanes of two trees that a walk may enter: all.
struct AllLanes {
    template <class TreeA, class TreeB>
    [[nodiscard]] kernels::BoxPairs kept(const TreeA& /*a*/, const typename TreeA::Cell& /*cell_a*/,
                                         const TreeB& /*b*/,
                                         const typename TreeB::Cell& /*cell_b*/) const noexcept {
        return ~kernels::BoxPairs{0};
    }
};

/// A walk of two trees of cells together, from above their roots down.
///
/// A tree has Cell, a node and its place, and these functions: top() returns the cell above the
/// roots. lanes() returns the set of children of a cell, at most eight. child() returns one of
/// them; is_leaf() and leaf_lanes() find the leaves. stored_bounds() returns the bounds of the
/// children if a file has them, and bound() computes them otherwise. A step bounds some children of
/// one node and some of another. One kernel call discards the pairs of them that are apart.
template <Search kSearch, class TreeA, class TreeB, class Lanes>
class CellWalk {
public:
    using CellA = typename TreeA::Cell;
    using CellB = typename TreeB::Cell;
    using Pair = CellPair<CellA, CellB>;

    CellWalk(const TreeA& a, const TreeB& b, const PlacedBoxes& placed, Descent descent,
             const Lanes& lanes) noexcept
        : a_(a), b_(b), placed_(placed), lanes_(lanes), descent_(descent) {}

    /// Keeps bounds and counts steps in the workspace. No walk within this one may do so.
    void use(Workspace::Storage& scratch) noexcept {
        counts_ = scratch.counts;
        kept_a_ = &cells_of(scratch).bounds_a;
        kept_b_ = &cells_of(scratch).bounds_b;
        ++kept_a_->question;
        ++kept_b_->question;
    }

    /// Calls leaf(pair, bounds_a, bounds_b) for each pair of leaf cells that no test separates,
    /// until it returns false. Returns false when it did.
    template <class Leaf>
    bool run(Leaf&& leaf) noexcept {
        std::size_t depth = 0;
        SomeChildren<CellA> side_a = {a_.top(), a_.lanes(a_.top())};
        SomeChildren<CellB> side_b = {b_.top(), b_.lanes(b_.top())};
        for (;;) {
            assert(depth < kMostSteps);
            Step& step = steps_[depth];
            open(side_a, side_b, step);
            if (!take_leaves(step, leaf)) return false;
            unsigned bit = step.pairs == 0 ? 0 : best(step.pairs);
            if (step.pairs == 0) {
                if (depth == 0) return true;
                bit = first_of(steps_[--depth].pairs);
            }
            Step& top = steps_[depth];
            assert((top.pairs >> bit & 1) != 0);
            choose(top, bit, side_a, side_b);
            top.pairs &= ~(kernels::BoxPairs{1} << bit);
            if (top.pairs != 0) ++depth;
        }
    }

private:
    struct Step {
        CellA a;
        CellB b;
        kernels::BoxPairs pairs;
        kernels::BoxSizes sizes;
    };
    // A step takes at least one side a level down.
    static constexpr std::size_t kMostSteps = TreeA::kMostLevels + TreeB::kMostLevels + 1;

    /// The bounds of the children of a cell.
    struct Opened {
        const format::BvhNode* boxes;
        const format::OrientedNode* oriented;  ///< or null
        unsigned leaf_lanes;
    };

    static kernels::NodeBoxes boxes_of(const Opened& opened, bool oriented) noexcept {
        return {opened.boxes->lower[0].data(),
                oriented ? opened.oriented->axis[0][0].data() : nullptr};
    }

    /// Returns bounds from the file, from where they are kept, or made at `place`.
    template <class Tree>
    static Opened opened(const Tree& tree, const typename Tree::Cell& cell, KeptBounds* kept,
                         KeptBounds::Place& place) noexcept {
        if (const StoredBounds stored = tree.stored_bounds(cell); stored.boxes != nullptr) {
            return {stored.boxes, stored.oriented, tree.leaf_lanes(cell)};
        }
        const KeptBounds::Place& made = made_bounds(tree, cell, kept, place);
        return {&made.bounds.boxes, Tree::kOriented ? &made.bounds.oriented : nullptr,
                made.leaf_lanes};
    }

    template <class Tree>
    static const KeptBounds::Place& made_bounds(const Tree& tree, const typename Tree::Cell& cell,
                                                KeptBounds* kept,
                                                KeptBounds::Place& place) noexcept {
        KeptBounds::Place& at =
            kept == nullptr ? place : kept->place[cell.node % KeptBounds::kPlaces];
        const std::uint64_t wanted = kept == nullptr ? 0 : kept->question << 32 | cell.node;
        if (wanted != 0 && at.holds == wanted) return at;
        at.holds = wanted;
        at.leaf_lanes = tree.leaf_lanes(cell);
        tree.bound(cell, at.bounds);
        return at;
    }

    void open(const SomeChildren<CellA>& side_a, const SomeChildren<CellB>& side_b,
              Step& step) noexcept {
        assert(side_a.lanes <= 0xff && side_b.lanes <= 0xff);
        step.a = side_a.parent;
        step.b = side_b.parent;
        step.pairs = 0;
        if (side_a.lanes == 0 || side_b.lanes == 0) return;  // in a damaged file
        opened_a_ = opened(a_, side_a.parent, kept_a_, place_a_);
        opened_b_ = opened(b_, side_b.parent, kept_b_, place_b_);
        const kernels::BoxChoice choice = {static_cast<std::uint8_t>(side_a.lanes),
                                           static_cast<std::uint8_t>(side_b.lanes), nullptr};
        const bool oriented = opened_a_.oriented != nullptr && opened_b_.oriented != nullptr;
        const kernels::NodeBoxes in_a = boxes_of(opened_a_, oriented);
        const kernels::NodeBoxes in_b = boxes_of(opened_b_, oriented);
        const kernels::Table& kernel = kernels::active();
        step.pairs =
            kSearch == Search::first
                ? kernel.overlap_depths(placed_.placement, in_a, in_b, choice, step.sizes, depths_)
                : kernel.overlapping_boxes(placed_.placement, in_a, in_b, choice, step.sizes);
        step.pairs &= lanes_.kept(a_, step.a, b_, step.b);
        if (counts_ != nullptr) {
            counts_->box_pairs += std::uint64_t{bits_in(side_a.lanes)} * bits_in(side_b.lanes);
            ++counts_->node_pairs;
        }
    }

    [[nodiscard]] unsigned best(kernels::BoxPairs pairs) const noexcept {
        return kSearch == Search::first ? deepest_of(pairs, depths_) : first_of(pairs);
    }

    /// Calls leaf() for the pairs of a step that are both leaves, and removes these pairs.
    template <class Leaf>
    bool take_leaves(Step& step, Leaf& leaf) noexcept {
        if (step.pairs == 0) return true;
        kernels::BoxPairs leaves =
            step.pairs & lane_pairs(opened_a_.leaf_lanes, opened_b_.leaf_lanes);
        step.pairs &= ~leaves;
        while (leaves != 0) {
            const unsigned bit = best(leaves);
            leaves &= ~(kernels::BoxPairs{1} << bit);
            if (!leaf(Pair{step.a, step.b, bit % 8, bit / 8}, CellBounds{*opened_a_.boxes},
                      CellBounds{*opened_b_.boxes})) {
                return false;
            }
        }
        return true;
    }

    /// Chooses what replaces a pair of children: the children of both, or the children of one with
    /// the other.
    void choose(const Step& step, unsigned bit, SomeChildren<CellA>& side_a,
                SomeChildren<CellB>& side_b) const noexcept {
        const unsigned lane_a = bit % 8;
        const unsigned lane_b = bit / 8;
        const CellA a = a_.child(step.a, lane_a);
        const CellB b = b_.child(step.b, lane_b);
        const bool a_can = !a_.is_leaf(a);
        const bool b_can = !b_.is_leaf(b);
        bool down_a = a_can;
        bool down_b = b_can;
        if (a_can && b_can && descent_ != Descent::both) {
            // Written so that a size that is NaN takes one side down too.
            down_a = descent_ == Descent::a_first ||
                     (descent_ == Descent::larger && step.sizes.a[lane_a] >= step.sizes.b[lane_b]);
            down_b = !down_a;
        }
        side_a = down_a ? SomeChildren<CellA>{a, a_.lanes(a)}
                        : SomeChildren<CellA>{step.a, 1U << lane_a};
        side_b = down_b ? SomeChildren<CellB>{b, b_.lanes(b)}
                        : SomeChildren<CellB>{step.b, 1U << lane_b};
    }

    kernels::BoxDepths depths_;
    std::array<Step, kMostSteps> steps_;
    const TreeA& a_;
    const TreeB& b_;
    const PlacedBoxes& placed_;
    QueryCounts* counts_ = nullptr;  ///< or null
    KeptBounds* kept_a_ = nullptr;   ///< or null
    KeptBounds* kept_b_ = nullptr;
    Opened opened_a_{};  ///< of the last step
    Opened opened_b_{};
    Lanes lanes_;
    KeptBounds::Place place_a_{};  ///< where none are kept
    KeptBounds::Place place_b_{};
    Descent descent_;
};

}  // namespace cdprep
