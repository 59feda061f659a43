// SPDX-License-Identifier: MIT
#include "query/self_walk.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/prefetch.h"
#include "walk/box_placement.h"
#include "walk/leaf_batch.h"

namespace cdprep {
namespace {

using format::BvhLeaf;
using format::BvhNode;
using format::kBvhWidth;

constexpr std::size_t kNumbersPerLeaf = std::size_t{3} * kBvhWidth;

/// Enough for a team of threads to share evenly, few enough for a scratch each.
constexpr std::size_t kParts = 128;

/// Bits 8 j + i with i <= j: each pair of a node's boxes once.
constexpr kernels::BoxPairs once_each() noexcept {
    kernels::BoxPairs pairs = 0;
    for (unsigned j = 0; j < kBvhWidth; ++j) {
        pairs |= kernels::BoxPairs{(2U << j) - 1} << (kBvhWidth * j);
    }
    return pairs;
}

}  // namespace

/// Collects pairs of leaves and tests their triangles many at a time.
class SelfWalk::Batch {
public:
    Batch(const SelfWalk& walk, Workspace::Storage& scratch,
          const std::function<void(const SelfPair&)>& found)
        : walk_(walk), scratch_(scratch), found_(found) {
        scratch_.leaf_scratch.begin();
    }

    void add(std::uint32_t leaf_a, std::uint32_t leaf_b) {
        const BvhLeaf* leaves = walk_.bvh_.leaves.data();
        prefetch(&leaves[leaf_b]);
        assert(count_ < kernels::kLeafBatch);
        scratch_.leaf_pairs[count_++] = {leaves[leaf_a].corner[0][0].data(),
                                         leaves[leaf_b].corner[0][0].data(),
                                         leaf_a,
                                         leaf_b,
                                         walk_.used_[leaf_a],
                                         walk_.used_[leaf_b]};
        if (count_ == kernels::kLeafBatch) flush();
    }

    void flush() {
        const std::size_t contacts = kernels::active().find_own_contacts(
            walk_.leaves_, scratch_.leaf_pairs.data(), count_, walk_.corner_numbers_.data(),
            scratch_.leaf_scratch);
        count_ = 0;
        for (std::size_t i = 0; i < contacts; ++i) {
            const kernels::TriangleContactLanes& contact = scratch_.leaf_scratch.found[i];
            const kernels::LeafPair& pair = scratch_.leaf_pairs[contact.pair];
            found_({pair.number_a * kBvhWidth + contact.a, pair.number_b * kBvhWidth + contact.b,
                    contact.certain});
        }
    }

private:
    const SelfWalk& walk_;
    Workspace::Storage& scratch_;
    const std::function<void(const SelfPair&)>& found_;
    std::size_t count_ = 0;
};

SelfWalk::SelfWalk(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
                   ParallelFor parallel_for)
    : bvh_(bvh), shape_(format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size()))) {
    const PlacedBoxes placed = place_upon_itself(bvh.frame.origin, bvh.frame.exponent);
    boxes_ = placed.placement;
    leaves_ = place_leaves(bvh, placed);
    if (bvh.order.empty()) return;
    read_leaves(triangles, parallel_for);
    find_starts();
}

void SelfWalk::read_leaves(std::span<const format::Triangle> triangles, ParallelFor parallel_for) {
    const std::size_t leaves = bvh_.leaves.size();
    corner_numbers_.resize(leaves * kNumbersPerLeaf);
    used_.resize(leaves);
    constexpr std::size_t kLeavesPerTask = 4096;
    const auto read = [&](std::size_t task) {
        const std::size_t first = task * kLeavesPerTask * kBvhWidth;
        const std::size_t last = std::min(bvh_.order.size(), first + kLeavesPerTask * kBvhWidth);
        for (std::size_t at = first; at < last; ++at) {
            const std::uint32_t triangle = bvh_.order[at];
            const std::size_t leaf = at / kBvhWidth, lane = at % kBvhWidth;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                corner_numbers_[leaf * kNumbersPerLeaf + corner * kBvhWidth + lane] =
                    triangles[triangle].vertex[corner];
            }
            used_[leaf] = static_cast<std::uint8_t>(used_[leaf] | 1U << lane);
        }
    };
    parallel_for((leaves + kLeavesPerTask - 1) / kLeavesPerTask, read);
}

std::size_t SelfWalk::part_count() const noexcept {
    return std::min(kParts, starts_.size());
}

template <class Step>
void SelfWalk::for_children(const NodePair& pair, Step&& step) const {
    assert(pair.height > 0 && pair.a <= pair.b);
    const std::uint32_t level = pair.height - 1;
    const auto chosen = [&](std::uint32_t node) {
        return static_cast<std::uint8_t>((1U << shape_.used_boxes(level, node)) - 1);
    };
    const BvhNode* nodes = &bvh_.nodes[shape_.first[level]];
    const kernels::BoxChoice choice = {chosen(pair.a), chosen(pair.b), nullptr};
    kernels::BoxSizes sizes;
    kernels::BoxPairs pairs = kernels::active().overlapping_boxes(
        boxes_, {nodes[pair.a].lower[0].data(), nullptr}, {nodes[pair.b].lower[0].data(), nullptr},
        choice, sizes);
    if (pair.a == pair.b) pairs &= once_each();
    for (; pairs != 0; pairs &= pairs - 1) {
        const auto bit = static_cast<std::uint32_t>(std::countr_zero(pairs));
        step(NodePair{level, pair.a * kBvhWidth + bit % kBvhWidth,
                      pair.b * kBvhWidth + bit / kBvhWidth});
    }
}

void SelfWalk::find_starts() {
    starts_ = {{shape_.levels, 0, 0}};
    std::vector<NodePair> below;
    while (starts_.size() < kParts && starts_.front().height > 1) {
        below.clear();
        for (const NodePair& pair : starts_) {
            for_children(pair, [&](const NodePair& child) { below.push_back(child); });
        }
        starts_.swap(below);
    }
}

/// Looks at the children of the next node pair.
std::size_t SelfWalk::step(Rest& rest, Batch& batch) const {
    const NodePair pair = rest.open_.back();
    rest.open_.pop_back();
    std::size_t work = 1;
    for_children(pair, [&](const NodePair& child) {
        if (child.height == 0) {
            batch.add(child.a, child.b);
            ++work;
        } else {
            rest.open_.push_back(child);
        }
    });
    return work;
}

SelfWalk::Rest SelfWalk::part(std::size_t number) const {
    assert(number < part_count());
    const std::size_t first = starts_.size() * number / part_count();
    const std::size_t last = starts_.size() * (number + 1) / part_count();
    Rest rest;
    rest.open_.assign(starts_.begin() + static_cast<std::ptrdiff_t>(first),
                      starts_.begin() + static_cast<std::ptrdiff_t>(last));
    return rest;
}

void SelfWalk::run(Rest& rest, Workspace::Storage& scratch,
                   const std::function<void(const SelfPair&)>& found,
                   const std::function<bool(std::size_t)>& is_enough) const {
    Batch batch(*this, scratch, found);
    while (!rest.empty() && !is_enough(step(rest, batch))) {
    }
    batch.flush();
}

}  // namespace cdprep
