// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/cells/overlap_through.h"
#include "cells/cell_storage.h"
#include "walk/contact_pairs.h"

namespace cdprep {

/// Returns whether two triangles are in contact, by the six segment-triangle tests of Feito and
/// Torres (1997).
inline bool in_contact_by_segments(const Corners& a, const Corners& b, Overlap overlap) noexcept {
    if (!triangles_touch_by_segments(a, b)) return false;
    if (overlap == Overlap::closed) return true;
    const TriangleContact kind = classify_contact(a, b);
    return kind == TriangleContact::cross || kind == TriangleContact::coplanar_overlap;
}

/// The last stage of a query through cells. It tests pairs of leaves of the two BVHs, or some of
/// their lanes, many at a time. Each pair of triangles in contact is answered once, however many
/// cells bring it.
///
/// A query begins with TestedPairs::begin() and may use several of these. `found(at_a, at_b)` is
/// called with numbers in tree order, until it returns false. Where there is no room to remember an
/// answer, `owns(place, at_a, at_b)` decides. It must be true for exactly one of all places that
/// bring the pair and list both triangles.
template <class Found, class Owns>
class CellContacts {
public:
    CellContacts(const Model& a, const Model& b, const Placement& placement,
                 const PlacedBoxes& placed, LeafTest leaf_test, const PairOptions& options,
                 Workspace::Storage& scratch, Found found, Owns owns) noexcept
        : scratch_(scratch),
          cells_(cells_of(scratch)),
          leaf_test_(leaf_test),
          options_(options),
          a_(moved_a(a, placement)),
          b_(moved_b(b, placement)),
          touch_(a, b, placement, options, scratch.counts),
          batch_(a, b, placed, scratch),
          found_(std::move(found)),
          owns_(std::move(owns)) {}

    /// Tests a few pairs of leaves at a time, so that a hit comes early.
    void hurry() noexcept {
        most_ = kHurriedBatch;
    }

    /// Adds pairs that were not tested yet. `place` is passed to `owns`. Returns false when `found`
    /// ended the query.
    bool add(const LeafLanes& a, const LeafLanes& b, std::uint64_t place) noexcept {
        const std::uint64_t pairs = pairs_of(a.lanes, b.lanes);
        TestedPairs::Held held = cells_.tested_pairs.hold(a.leaf, b.leaf, pairs);
        if (held.fresh == 0) return true;
        if (!held.has_room) {
            if (!flush()) return false;
            held = cells_.tested_pairs.hold(a.leaf, b.leaf, pairs);
            forgets_ |= !held.has_room;
        }
        cells_.pending_leaves[batch_.size()] = {place, held.fresh, held.has_room};
        batch_.add(a.leaf, a.lanes, b.leaf, b.lanes);
        return batch_.size() < most_ || flush();
    }

    /// The same for a caller that brings no two leaves twice. Remembers nothing, and calls `owns`
    /// for all answers.
    bool add_once(const LeafLanes& a, const LeafLanes& b) noexcept {
        cells_.pending_leaves[batch_.size()] = {0, ~std::uint64_t{0}, false};
        batch_.add(a.leaf, a.lanes, b.leaf, b.lanes);
        return batch_.size() < most_ || flush();
    }

    /// Returns whether there was no room to remember some answers. From then on every place must
    /// bring what it lists, tested before or not.
    [[nodiscard]] bool forgets() const noexcept {
        return forgets_;
    }

    /// Tests all that was added. Returns false when `found` ended the query.
    bool flush() noexcept {
        if (batch_.size() == 0) return true;
        const std::size_t count = batch_.size();
        const bool whole =
            leaf_test_ == LeafTest::feito_torres ? flush_by_segments(count) : flush_by_kernel();
        if (whole) settle(count);
        return whole;
    }

private:
    static constexpr std::size_t kHurriedBatch = 4;

    /// Returns a set of pairs with bits as in TestedPairs.
    static std::uint64_t pairs_of(std::uint8_t lanes_a, std::uint8_t lanes_b) noexcept {
        std::uint64_t pairs = 0;
        for (unsigned rest = lanes_b; rest != 0; rest &= rest - 1) {
            pairs |= std::uint64_t{lanes_a} << (8 * std::countr_zero(rest));
        }
        return pairs;
    }

    bool flush_by_kernel() noexcept {
        answered_ = 0;
        return batch_.flush_numbered(
            [&](std::size_t pair, std::uint32_t at_a, std::uint32_t at_b, bool certain) {
                return !touch_(at_a, at_b, certain) || answer(pair, at_a, at_b);
            });
    }

    /// Tests every pair of triangles by the exact test, without float.
    bool flush_by_segments(std::size_t count) noexcept;

    /// Handles two triangles of pair `pair` that are in contact.
    bool answer(std::size_t pair, std::uint32_t at_a, std::uint32_t at_b) noexcept {
        const PendingLeaves& leaves = cells_.pending_leaves[pair];
        const std::uint32_t bit = 8 * (at_b % format::kBvhWidth) + at_a % format::kBvhWidth;
        answered_ |= 1U << pair;
        if (((leaves.fresh >> bit) & 1) == 0) return true;
        if (!leaves.is_held && !owns_(leaves.place, at_a, at_b)) return true;
        return static_cast<bool>(found_(at_a, at_b));
    }
    void settle(std::size_t count) noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            if (!cells_.pending_leaves[i].is_held) continue;
            const kernels::LeafPair& pair = batch_.pair(i);
            cells_.tested_pairs.settle(pair.number_a, pair.number_b, ((answered_ >> i) & 1) != 0);
        }
    }

    Workspace::Storage& scratch_;
    CellStorage& cells_;
    LeafTest leaf_test_;
    PairOptions options_;
    MovedModel a_;
    MovedModel b_;
    ContactTest touch_;
    LeafBatch batch_;
    Found found_;
    Owns owns_;

    std::size_t most_ = kernels::kLeafBatch;  ///< pairs of leaves at a time
    bool forgets_ = false;
    std::uint32_t answered_ = 0;  ///< of the batch: bit set of pairs
};

template <class Found, class Owns>
bool CellContacts<Found, Owns>::flush_by_segments(std::size_t count) noexcept {
    answered_ = 0;
    batch_.clear();
    for (std::size_t i = 0; i < count; ++i) {
        const kernels::LeafPair& pair = batch_.pair(i);
        for (unsigned rest_b = pair.used_b; rest_b != 0; rest_b &= rest_b - 1) {
            const std::uint32_t at_b =
                pair.number_b * format::kBvhWidth + static_cast<unsigned>(std::countr_zero(rest_b));
            const Corners corners_b = b_.corners(at_b);
            const Box3 box_b = box_around(corners_b);
            for (unsigned rest_a = pair.used_a; rest_a != 0; rest_a &= rest_a - 1) {
                const std::uint32_t at_a = pair.number_a * format::kBvhWidth +
                                           static_cast<unsigned>(std::countr_zero(rest_a));
                const Corners corners_a = a_.corners(at_a);
                if (!overlap(box_around(corners_a), box_b)) continue;
                if (touch_.skips(at_a, at_b)) continue;
                if (scratch_.counts != nullptr) ++scratch_.counts->by_exact;
                if (!in_contact_by_segments(corners_a, corners_b, options_.overlap)) continue;
                if (!answer(i, at_a, at_b)) return false;
            }
        }
    }
    return true;
}

}  // namespace cdprep
