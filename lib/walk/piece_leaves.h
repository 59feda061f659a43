// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cdprep/format/pieces.h"
#include "cdprep/model.h"
#include "walk/leaf_batch.h"
#include "walk/walk_pairs.h"

namespace cdprep {

/// The leaves of a model's hierarchy over pieces.
///
/// The triangles of one such leaf are spread over two or three leaves of the BVH, among others. If
/// the BVH leaves hold the vertices without loss, the triangles are gathered into a leaf of their
/// own, once a query. A fourth of the leaf pairs then remains to be tested. Otherwise, or if there
/// is no room, the triangles are tested in place.
class PieceLeaves {
public:
    explicit PieceLeaves(const Model& model) noexcept
        : leaves_(model.pieces().leaves.data()),
          triangles_(model.pieces().triangles.data()),
          exact_(model.has_exact_leaves() ? model.bvh().leaves.data() : nullptr),
          exponent_(model.header().frame_exponent),
          count_(static_cast<std::uint32_t>(model.pieces().leaves.size())) {}

    [[nodiscard]] Tree tree(const Model& model) const noexcept {
        Tree tree(model);
        tree.nodes = model.pieces().nodes.data();
        tree.oriented = nullptr;
        tree.swept = model.pieces().swept.data();
        tree.swept_kind = format::SweptKind::rectangle;
        tree.shape = format::piece_tree_shape(count_);
        if (count_ == 0) tree.triangles = 0;
        return tree;
    }

    /// Calls test(view) for views that together hold the leaf's triangles. Stops and returns false
    /// when `test` returns false. `view_of(lanes)` is the view of triangles in place.
    template <class ViewOf, class Test>
    bool each_view(std::uint32_t number, GatheredLeaves& gathered,
                   const Workspace::Storage& scratch, ViewOf&& view_of,
                   Test&& test) const noexcept {
        assert(number < count_);
        const format::PieceLeaf& leaf = leaves_[number];
        assert(leaf.count > 0 && leaf.count <= format::kBvhWidth);
        if (exact_ != nullptr) {
            if (const format::BvhLeaf* own = put_together(number, gathered, scratch)) {
                const auto used = static_cast<std::uint8_t>((1U << leaf.count) - 1);
                return test(LeafView{own->corner[0][0].data(), number | kOwn, used});
            }
        }
        LeafLanes lanes = {};
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const std::uint32_t triangle = triangles_[leaf.first_triangle + i];
            const std::uint32_t holder = triangle / format::kBvhWidth;
            if (lanes.lanes != 0 && holder != lanes.leaf) {
                if (!test(view_of(lanes))) return false;
                lanes.lanes = 0;
            }
            lanes.leaf = holder;
            lanes.lanes |= static_cast<std::uint8_t>(1U << (triangle % format::kBvhWidth));
        }
        return test(view_of(lanes));
    }

    /// Marks a view as used by the current batch. A view may outlive a test that emptied the batch.
    /// Without the mark its room could go to another leaf while a pair in the batch points to it.
    static void keep(const LeafView& view, GatheredLeaves& gathered,
                     const Workspace::Storage& scratch) noexcept {
        if ((view.number & kOwn) == 0) return;
        gathered.wanted[view.number % kernels::kLeafPlaces] = scratch.leaf_batch;
    }

    /// Returns the tree-order number of the triangle to which a LeafBatch gives the number `named`.
    [[nodiscard]] std::uint32_t triangle(std::uint32_t named) const noexcept {
        const std::uint32_t number = named / format::kBvhWidth;
        if ((number & kOwn) == 0) return named;
        assert((number & ~kOwn) < count_);
        return triangles_[leaves_[number & ~kOwn].first_triangle + named % format::kBvhWidth];
    }

private:
    /// Marks the numbers of gathered leaves. No leaf's number is as large, and eight times a marked
    /// number still fits.
    static constexpr std::uint32_t kOwn = std::uint32_t{1} << 28;
    static_assert(format::kMaxPieceLeaves < kOwn);

    /// Returns null if there is no room: the leaf in its place is still to be tested.
    const format::BvhLeaf* put_together(std::uint32_t number, GatheredLeaves& gathered,
                                        const Workspace::Storage& scratch) const noexcept {
        const std::size_t place = number % kernels::kLeafPlaces;
        const bool holds =
            gathered.holds[place] == number && gathered.walk[place] == scratch.piece_walks;
        if (!holds) {
            if (gathered.wanted[place] == scratch.leaf_batch) return nullptr;
            gathered.holds[place] = number;
            gathered.walk[place] = scratch.piece_walks;
            fill(leaves_[number], gathered.leaf[place]);
        }
        gathered.wanted[place] = scratch.leaf_batch;
        return &gathered.leaf[place];
    }

    void fill(const format::PieceLeaf& leaf, format::BvhLeaf& own) const noexcept {
        for (std::uint32_t lane = 0; lane < format::kBvhWidth; ++lane) {
            const std::uint32_t i = std::min(lane, leaf.count - 1);
            const std::uint32_t triangle = triangles_[leaf.first_triangle + i];
            const format::BvhLeaf& holder = exact_[triangle / format::kBvhWidth];
            const std::uint32_t from = triangle % format::kBvhWidth;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    own.corner[corner][axis][lane] = holder.corner[corner][axis][from];
                }
            }
        }
        for (std::size_t axis = 0; axis < 3; ++axis) set_middle(own, axis);
    }
    /// Sets the origin and half extent as build_bvh() does: the origin near the middle, the half
    /// extent at least the distance of any corner.
    void set_middle(format::BvhLeaf& own, std::size_t axis) const noexcept {
        float lower = own.corner[0][axis][0];
        float upper = lower;
        for (const auto& corner : own.corner) {
            for (const float x : corner[axis]) {
                lower = x < lower ? x : lower;
                upper = upper < x ? x : upper;
            }
        }
        own.origin[axis] = static_cast<float>(0.5 * double{lower} + 0.5 * double{upper});
        const double origin = double{own.origin[axis]};
        const double reach = std::max(double{upper} - origin, origin - double{lower});
        // Twice the rounding to float, and more than the rounding of the difference.
        constexpr double kEnlarged = 1 + 0x1p-22;
        const auto half = static_cast<float>(std::ldexp(reach, exponent_) * kEnlarged);
        own.half[axis] = std::max(half, std::numeric_limits<float>::min());
    }

    const format::PieceLeaf* leaves_;
    const std::uint32_t* triangles_;
    const format::BvhLeaf* exact_;  ///< or null: the leaves do not hold the vertices
    std::int32_t exponent_;
    std::uint32_t count_;
};

}  // namespace cdprep
