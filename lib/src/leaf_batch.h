// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "box_placement.h"
#include "moved_leaf.h"
#include "workspace_storage.h"

namespace cdprep {

/// Collects pairs of leaves and tests their triangles many at a time.
class LeafBatch {
public:
    LeafBatch(const Model& a, const Model& b, const PlacedBoxes& placed,
              Workspace::Storage& scratch) noexcept;

    [[nodiscard]] bool full() const noexcept {
        return count_ == kernels::kLeafBatch;
    }
    void add(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept;

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
            const std::uint64_t leaves = scratch_.leaf_numbers[contact.pair];
            const auto first_a = static_cast<std::uint32_t>(leaves >> 32) * format::kBvhWidth;
            const auto first_b = static_cast<std::uint32_t>(leaves) * format::kBvhWidth;
            if (!found(first_a + contact.a, first_b + contact.b, contact.certain)) return false;
        }
        return true;
    }

private:
    /// A model's leaves as the kernel wants them.
    struct Side {
        const format::BvhLeaf* leaves;
        bool exact;
        double frame_scale;                  ///< from stored coordinates to pair units
        std::array<double, 3> frame_origin;  ///< in stored coordinates
        float box_scale;                     ///< from frame units to pair units

        Side(const Model& model, double scale) noexcept;
        [[nodiscard]] std::array<double, 3> origin(const format::BvhLeaf& leaf) const noexcept;
    };

    Workspace::Storage& scratch_;
    Side a_;
    Side b_;
    std::array<double, 9> rotation_;
    std::array<double, 3> shift_;
    float error_;
    kernels::LeafPlacement placement_;
    std::size_t count_ = 0;
};

}  // namespace cdprep
