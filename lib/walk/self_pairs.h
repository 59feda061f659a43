// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/model.h"
#include "kernels/kernels.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// The boxes of one hierarchy, for walks of it against itself.
class SelfBoxes {
public:
    /// `placement` is that of the hierarchy upon itself.
    SelfBoxes(const format::BvhNode* nodes, const format::BvhShape& shape,
              const kernels::BoxPlacement& placement) noexcept
        : nodes_(nodes), shape_(shape), placement_(placement) {}

    /// Calls step(child_a, child_b), child_a <= child_b, for each pair of children of two nodes
    /// whose boxes overlap, once. The nodes a <= b are of one height, which is above 0.
    template <class Step>
    void for_children(std::uint32_t height, std::uint32_t a, std::uint32_t b, Step&& step) const {
        assert(height > 0 && a <= b);
        const format::BvhNode* nodes = nodes_ + shape_.first[height - 1];
        const kernels::BoxChoice choice = {used(height, a), used(height, b), nullptr};
        kernels::BoxSizes sizes;
        kernels::BoxPairs pairs =
            kernels::active().overlapping_boxes(placement_, {nodes[a].lower[0].data(), nullptr},
                                                {nodes[b].lower[0].data(), nullptr}, choice, sizes);
        if (a == b) pairs &= once_each();
        for (; pairs != 0; pairs &= pairs - 1) {
            const auto bit = static_cast<std::uint32_t>(std::countr_zero(pairs));
            step(a * format::kBvhWidth + bit % format::kBvhWidth,
                 b * format::kBvhWidth + bit / format::kBvhWidth);
        }
    }

    /// Counts the work of one step.
    void count_step(std::uint32_t height, std::uint32_t a, std::uint32_t b,
                    QueryCounts& counts) const noexcept {
        const std::uint64_t boxes_a = shape_.used_boxes(height - 1, a);
        const std::uint64_t boxes_b = shape_.used_boxes(height - 1, b);
        counts.box_pairs += a == b ? boxes_a * (boxes_a + 1) / 2 : boxes_a * boxes_b;
        ++counts.node_pairs;
    }

    [[nodiscard]] std::uint32_t levels() const noexcept {
        return shape_.levels;
    }

private:
    /// Returns the bits 8 j + i with i <= j: each pair of a node's boxes once.
    static constexpr kernels::BoxPairs once_each() noexcept {
        kernels::BoxPairs pairs = 0;
        for (unsigned j = 0; j < format::kBvhWidth; ++j) {
            pairs |= kernels::BoxPairs{(2U << j) - 1} << (format::kBvhWidth * j);
        }
        return pairs;
    }
    [[nodiscard]] std::uint8_t used(std::uint32_t height, std::uint32_t node) const noexcept {
        return static_cast<std::uint8_t>((1U << shape_.used_boxes(height - 1, node)) - 1);
    }

    const format::BvhNode* nodes_;
    format::BvhShape shape_;
    kernels::BoxPlacement placement_;
};

/// The numbers of the vertices of a model's leaves, gathered into the workspace when they are
/// needed. Leaves of one batch keep their places.
class LeafNumbers {
public:
    LeafNumbers(const Model& model, GatheredNumbers& room) noexcept
        : triangles_(model.mesh().triangles.data()),
          last_(model.triangle_count() - 1),
          room_(room) {
        room_.holds.fill(GatheredNumbers::kNoLeaf);
        room_.taken = 0;
    }

    /// Returns whether no other leaf of this batch has the place of the leaf.
    [[nodiscard]] bool has_place(std::uint32_t leaf) const noexcept {
        const std::size_t at = leaf % kernels::kLeafPlaces;
        return room_.holds[at] == leaf || (room_.taken >> at & 1) == 0;
    }
    /// Returns the numbers as the kernel takes them: [corner][lane]. They stay until the next
    /// batch. Lanes without a triangle hold any numbers.
    [[nodiscard]] const std::uint32_t* of(std::uint32_t leaf) noexcept {
        assert(has_place(leaf));
        const std::size_t at = leaf % kernels::kLeafPlaces;
        room_.taken |= std::uint64_t{1} << at;
        if (room_.holds[at] != leaf) gather(leaf, room_.numbers[at].data());
        room_.holds[at] = leaf;
        return room_.numbers[at].data();
    }
    void next_batch() noexcept {
        room_.taken = 0;
    }

private:
    void gather(std::uint32_t leaf, std::uint32_t* numbers) const noexcept {
        for (std::uint32_t lane = 0; lane < format::kBvhWidth; ++lane) {
            const std::uint32_t place = std::min(leaf * format::kBvhWidth + lane, last_);
            for (std::size_t corner = 0; corner < 3; ++corner) {
                numbers[corner * format::kBvhWidth + lane] = triangles_[place].vertex[corner];
            }
        }
    }

    const format::Triangle* triangles_;
    std::uint32_t last_;
    GatheredNumbers& room_;
};

}  // namespace cdprep
