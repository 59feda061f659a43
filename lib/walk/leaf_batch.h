// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <span>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/api.h"
#include "core/moved_model.h"
#include "core/prefetch.h"
#include "walk/box_placement.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Some triangles of a BVH leaf.
struct LeafLanes {
    std::uint32_t leaf;
    std::uint8_t lanes;  ///< bit set
};

/// Returns the relative placement of the leaves of two models.
[[nodiscard]] CDPREP_API kernels::LeafPlacement place_leaves(const Model& a, const Model& b,
                                                             const PlacedBoxes& placed) noexcept;

/// Returns the placement of the leaves of a tree relative to themselves.
[[nodiscard]] kernels::LeafPlacement place_leaves(const build::Bvh& tree,
                                                  const PlacedBoxes& placed) noexcept;

/// The lanes of leaves that have a triangle. Found without reading a leaf, which may be far away in
/// memory. Unless the model can tear, only the last leaf may hold fewer than eight triangles.
class UsedLanes {
public:
    explicit UsedLanes(const Model& model) noexcept
        : UsedLanes(model.triangle_count(), model.bvh().lanes.data()) {}
    explicit UsedLanes(const build::Bvh& tree) noexcept
        : UsedLanes(static_cast<std::uint32_t>(tree.order.size()), nullptr) {}

    [[nodiscard]] std::uint8_t operator()(std::uint32_t leaf) const noexcept {
        if (lanes_ != nullptr) return lanes_[leaf];
        return leaf == last_ ? used_in_last_ : std::uint8_t{0xff};
    }

private:
    UsedLanes(std::uint32_t triangles, const std::uint8_t* lanes) noexcept
        : lanes_(lanes),
          last_((triangles - 1) / format::kBvhWidth),
          used_in_last_(
              static_cast<std::uint8_t>((2U << ((triangles - 1) % format::kBvhWidth)) - 1)) {}

    const std::uint8_t* lanes_;  ///< or null: the model cannot tear
    std::uint32_t last_;
    std::uint8_t used_in_last_;
};

/// Triangles in the form that the kernels take: those of a leaf, or gathered like one.
struct LeafView {
    const float* leaf;
    std::uint32_t number;  ///< identifies the leaf among those of its model
    std::uint8_t used;     ///< bit set of triangles
};

/// Collects pairs of leaves and tests their triangles many at a time.
class LeafBatch {
public:
    LeafBatch(const Model& a, const Model& b, const PlacedBoxes& placed,
              Workspace::Storage& scratch) noexcept
        : scratch_(scratch),
          leaves_a_(a.bvh().leaves.data()),
          leaves_b_(b.bvh().leaves.data()),
          used_a_(a),
          used_b_(b),
          source_a_(a.source().triangle.data()),
          source_b_(b.source().triangle.data()),
          placement_(place_leaves(a, b, placed)) {
        scratch_.leaf_scratch.begin();
    }
    /// For pairs of leaves of one tree. Answers are in its order.
    LeafBatch(const build::Bvh& tree, const PlacedBoxes& placed,
              Workspace::Storage& scratch) noexcept
        : scratch_(scratch),
          leaves_a_(tree.leaves.data()),
          leaves_b_(tree.leaves.data()),
          used_a_(tree),
          used_b_(tree),
          source_a_(nullptr),
          source_b_(nullptr),
          placement_(place_leaves(tree, placed)) {
        scratch_.leaf_scratch.begin();
    }

    [[nodiscard]] bool full() const noexcept {
        return count_ == kernels::kLeafBatch;
    }
    [[nodiscard]] const kernels::LeafPlacement& placement() const noexcept {
        return placement_;
    }
    void prefetch_pair(std::uint32_t leaf_a, std::uint32_t leaf_b) const noexcept {
        prefetch(&leaves_a_[leaf_a]);
        prefetch(&leaves_b_[leaf_b]);
        prefetch_sources(source_a_, leaf_a);
        prefetch_sources(source_b_, leaf_b);
    }
    void add(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        assert(!full());
        prefetch_pair(leaf_a, leaf_b);
        set_pair(count_++, leaf_a, leaf_b);
    }
    /// As above, for some of their triangles: bit sets.
    void add(std::uint32_t leaf_a, std::uint8_t lanes_a, std::uint32_t leaf_b,
             std::uint8_t lanes_b) noexcept {
        add(leaf_a, leaf_b);
        kernels::LeafPair& pair = scratch_.leaf_pairs[count_ - 1];
        pair.used_a &= lanes_a;
        pair.used_b &= lanes_b;
    }
    /// As above, for flush_own(). `numbers` must stay until then. A walk of one tree meets few
    /// leaves in a row, so only B's is prefetched.
    void add(std::uint32_t leaf_a, std::uint32_t leaf_b,
             const kernels::CornerNumbers& numbers) noexcept {
        assert(!full());
        prefetch(&leaves_b_[leaf_b]);
        scratch_.corner_numbers[count_] = numbers;
        set_pair(count_++, leaf_a, leaf_b);
    }
    /// Returns a view of some triangles of a leaf.
    [[nodiscard]] LeafView view_a(const LeafLanes& in_a) const noexcept {
        const auto used = static_cast<std::uint8_t>(used_a_(in_a.leaf) & in_a.lanes);
        return {leaves_a_[in_a.leaf].corner[0][0].data(), in_a.leaf, used};
    }
    [[nodiscard]] LeafView view_b(const LeafLanes& in_b) const noexcept {
        const auto used = static_cast<std::uint8_t>(used_b_(in_b.leaf) & in_b.lanes);
        return {leaves_b_[in_b.leaf].corner[0][0].data(), in_b.leaf, used};
    }
    void add(const LeafView& in_a, const LeafView& in_b) noexcept {
        assert(!full());
        scratch_.leaf_pairs[count_++] = pair_of(in_a, in_b);
    }
    /// Returns a pair added since the last flush. Until one is added, returns a pair of that flush.
    [[nodiscard]] const kernels::LeafPair& pair(std::size_t index) const noexcept {
        assert(index < kernels::kLeafBatch);
        return scratch_.leaf_pairs[index];
    }
    [[nodiscard]] std::size_t size() const noexcept {
        return count_;
    }
    /// Forgets the pairs added, for callers that test them in another way.
    void clear() noexcept {
        if (scratch_.counts != nullptr) count_batch(*scratch_.counts, count_);
        count_ = 0;
    }

    /// Empties the batch. Calls found(triangle_a, triangle_b, certain), tree order, for every pair
    /// of triangles that certainly crosses or may touch. Stops and returns false when `found`
    /// returns false.
    template <class Found>
    bool flush(Found&& found) noexcept {
        return flush_numbered([&](std::size_t /*pair*/, std::uint32_t at_a, std::uint32_t at_b,
                                  bool certain) { return found(at_a, at_b, certain); });
    }

    /// As flush(), for leaves of one tree that were all added with the numbers of their vertices.
    /// Leaves out pairs with a common vertex. Of a leaf and itself, it gives each pair once.
    template <class Found>
    bool flush_own(Found&& found) noexcept {
        const std::size_t contacts = kernels::active().find_own_contacts(
            placement_, scratch_.leaf_pairs.data(), count_, scratch_.corner_numbers.data(),
            scratch_.leaf_scratch);
        return hand_over(contacts, [&](std::size_t /*pair*/, std::uint32_t at_a, std::uint32_t at_b,
                                       bool certain) { return found(at_a, at_b, certain); });
    }

    /// As flush(), by found(pair, triangle_a, triangle_b, certain) with the number of the pair of
    /// leaves. Triangles of one pair of leaves are consecutive.
    template <class Found>
    bool flush_numbered(Found&& found) noexcept {
        const std::size_t contacts = kernels::active().find_contacts(
            placement_, scratch_.leaf_pairs.data(), count_, scratch_.leaf_scratch);
        return hand_over(contacts, found);
    }

    /// Empties the batch. Calls found(triangle_a, triangle_b, gap), tree order, for every pair of
    /// triangles that may be at most reach.limit apart. Stops and returns false when `found`
    /// returns false.
    template <class Found>
    bool flush_within(const kernels::Reach& reach, Found&& found) noexcept {
        const std::size_t near = kernels::active().triangles_within(
            placement_, scratch_.leaf_pairs.data(), count_, reach, scratch_.leaf_scratch);
        ++scratch_.leaf_batch;
        if (scratch_.counts != nullptr) count_batch(*scratch_.counts, count_);
        count_ = 0;
        for (std::size_t i = 0; i < near; ++i) {
            const kernels::TriangleGap& gap = scratch_.leaf_scratch.gap[i];
            assert(gap.pair < kernels::kLeafBatch);
            assert(gap.a < format::kBvhWidth && gap.b < format::kBvhWidth);
            const kernels::LeafPair& pair = scratch_.leaf_pairs[gap.pair];
            const std::uint32_t at_a = pair.number_a * format::kBvhWidth + gap.a;
            const std::uint32_t at_b = pair.number_b * format::kBvhWidth + gap.b;
            if (!found(at_a, at_b, gap)) return false;
        }
        return true;
    }

    /// Returns the triangles of parts of two leaves that may be at most reach.limit apart. Valid
    /// until the next call.
    std::span<kernels::TriangleGap> near_triangles(const LeafView& in_a, const LeafView& in_b,
                                                   const kernels::Reach& reach) noexcept {
        assert(count_ == 0);  // uses the first place of the batch
        scratch_.leaf_pairs[0] = pair_of(in_a, in_b);
        ++scratch_.leaf_batch;
        if (scratch_.counts != nullptr) count_batch(*scratch_.counts, 1);
        const std::size_t found = kernels::active().near_triangles(
            placement_, scratch_.leaf_pairs[0], reach, scratch_.leaf_scratch);
        return std::span(scratch_.leaf_scratch.gap, found);
    }

private:
    /// Empties the batch, of which a kernel found so many contacts.
    template <class Found>
    bool hand_over(std::size_t contacts, Found&& found) noexcept {
        ++scratch_.leaf_batch;
        if (scratch_.counts != nullptr) count_batch(*scratch_.counts, count_);
        count_ = 0;
        for (std::size_t i = 0; i < contacts; ++i) {
            const kernels::TriangleContactLanes& contact = scratch_.leaf_scratch.found[i];
            assert(contact.pair < kernels::kLeafBatch);
            assert(contact.a < format::kBvhWidth && contact.b < format::kBvhWidth);
            const kernels::LeafPair& pair = scratch_.leaf_pairs[contact.pair];
            const std::uint32_t at_a = pair.number_a * format::kBvhWidth + contact.a;
            const std::uint32_t at_b = pair.number_b * format::kBvhWidth + contact.b;
            if (!found(std::size_t{contact.pair}, at_a, at_b, contact.certain)) return false;
        }
        return true;
    }
    static kernels::LeafPair pair_of(const LeafView& in_a, const LeafView& in_b) noexcept {
        return {in_a.leaf, in_b.leaf, in_a.number, in_b.number, in_a.used, in_b.used};
    }
    void set_pair(std::size_t at, std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        scratch_.leaf_pairs[at] = {leaves_a_[leaf_a].corner[0][0].data(),
                                   leaves_b_[leaf_b].corner[0][0].data(),
                                   leaf_a,
                                   leaf_b,
                                   used_a_(leaf_a),
                                   used_b_(leaf_b)};
    }
    static void prefetch_sources(const std::uint32_t* sources, std::uint32_t leaf) noexcept {
        if (sources != nullptr) prefetch(sources + std::size_t{leaf} * format::kBvhWidth);
    }
    void count_batch(QueryCounts& counts, std::size_t pairs) const noexcept {
        counts.leaf_pairs += pairs;
        for (std::size_t i = 0; i < pairs; ++i) {
            const kernels::LeafPair& pair = scratch_.leaf_pairs[i];
            counts.triangle_pairs += std::uint64_t(std::popcount(pair.used_a)) *
                                     static_cast<unsigned>(std::popcount(pair.used_b));
        }
    }
    Workspace::Storage& scratch_;
    const format::BvhLeaf* leaves_a_;
    const format::BvhLeaf* leaves_b_;
    UsedLanes used_a_;
    UsedLanes used_b_;
    const std::uint32_t* source_a_;  ///< or null
    const std::uint32_t* source_b_;
    kernels::LeafPlacement placement_;
    std::size_t count_ = 0;
};

}  // namespace cdprep
