// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "box_placement.h"
#include "moved_model.h"
#include "prefetch.h"
#include "workspace_storage.h"

namespace cdprep {

/// How the leaves of two models stand to each other.
[[nodiscard]] kernels::LeafPlacement place_leaves(const Model& a, const Model& b,
                                                  const PlacedBoxes& placed) noexcept;

/// Collects pairs of leaves and tests their triangles many at a time.
class LeafBatch {
public:
    LeafBatch(const Model& a, const Model& b, const PlacedBoxes& placed,
              Workspace::Storage& scratch) noexcept
        : scratch_(scratch),
          leaves_a_(a.leaves().data()),
          leaves_b_(b.leaves().data()),
          source_a_(a.source_triangle().data()),
          source_b_(b.source_triangle().data()),
          placement_(place_leaves(a, b, placed)) {
        scratch_.leaf_scratch.begin();
    }

    [[nodiscard]] bool full() const noexcept {
        return count_ == kernels::kLeafBatch;
    }
    void add(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        prefetch(&leaves_a_[leaf_a]);
        prefetch(&leaves_b_[leaf_b]);
        prefetch_sources(source_a_, leaf_a);
        prefetch_sources(source_b_, leaf_b);
        set_pair(count_++, leaf_a, leaf_b);
    }

    /// Calls found(triangle_a, triangle_b, certain), in tree order, for every pair
    /// of triangles that crosses for certain or may touch, until it returns
    /// false; empties the batch. Returns false when it did.
    template <class Found>
    bool flush(Found&& found) noexcept {
        const std::size_t contacts = kernels::active().find_contacts(
            placement_, scratch_.leaf_pairs.data(), count_, scratch_.leaf_scratch);
        count_ = 0;
        for (std::size_t i = 0; i < contacts; ++i) {
            const kernels::TriangleContactLanes& contact = scratch_.leaf_scratch.found[i];
            const kernels::LeafPair& pair = scratch_.leaf_pairs[contact.pair];
            const std::uint32_t at_a = pair.number_a * format::kBvhWidth + contact.a;
            const std::uint32_t at_b = pair.number_b * format::kBvhWidth + contact.b;
            if (!found(at_a, at_b, contact.certain)) return false;
        }
        return true;
    }

    /// Triangles of one pair of leaves that may be as near as reach.limit. Valid
    /// until the next call.
    std::span<kernels::TriangleGap> near_triangles(std::uint32_t leaf_a, std::uint32_t leaf_b,
                                                   const kernels::Reach& reach) noexcept {
        set_pair(0, leaf_a, leaf_b);
        const std::size_t found = kernels::active().near_triangles(
            placement_, scratch_.leaf_pairs[0], reach, scratch_.leaf_scratch);
        return std::span(scratch_.leaf_scratch.gap, found);
    }

private:
    void set_pair(std::size_t at, std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        const format::BvhLeaf& a = leaves_a_[leaf_a];
        const format::BvhLeaf& b = leaves_b_[leaf_b];
        scratch_.leaf_pairs[at] = {a.corner[0][0].data(), b.corner[0][0].data(), leaf_a, leaf_b,
                                   used_lanes(a),         used_lanes(b)};
    }
    static void prefetch_sources(const std::uint32_t* sources, std::uint32_t leaf) noexcept {
        if (sources != nullptr) prefetch(sources + std::size_t{leaf} * format::kBvhWidth);
    }
    static std::uint8_t used_lanes(const format::BvhLeaf& leaf) noexcept {
        return static_cast<std::uint8_t>((1U << leaf.count) - 1);
    }

    Workspace::Storage& scratch_;
    const format::BvhLeaf* leaves_a_;
    const format::BvhLeaf* leaves_b_;
    const std::uint32_t* source_a_;  ///< or null
    const std::uint32_t* source_b_;
    kernels::LeafPlacement placement_;
    std::size_t count_ = 0;
};

}  // namespace cdprep
