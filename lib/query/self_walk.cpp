// SPDX-License-Identifier: MIT
#include "cdprep/advanced/self_walk.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "cdprep/format/float_environment.h"
#include "core/prefetch.h"
#include "walk/box_placement.h"
#include "walk/leaf_batch.h"
#include "walk/workspace_storage.h"

namespace cdprep {
namespace {

using format::BvhLeaf;
using format::BvhNode;
using format::kBvhWidth;

constexpr std::size_t kNumbersPerLeaf = std::size_t{3} * kBvhWidth;

/// Enough for a team of threads to share evenly, and few enough for a scratch each.
constexpr std::size_t kParts = 128;

/// Returns the bits 8 j + i with i <= j: each pair of a node's boxes once.
constexpr kernels::BoxPairs once_each() noexcept {
    kernels::BoxPairs pairs = 0;
    for (unsigned j = 0; j < kBvhWidth; ++j) {
        pairs |= kernels::BoxPairs{(2U << j) - 1} << (kBvhWidth * j);
    }
    return pairs;
}

}  // namespace

/// The hierarchy as the walk reads it.
class SelfWalk::Tree {
public:
    class Batch;

    Tree(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
         ParallelFor parallel_for);

    /// Calls step(pair) for each pair of children whose boxes overlap.
    template <class Step>
    void for_children(const NodePair& pair, Step&& step) const;

    [[nodiscard]] NodePair root() const noexcept {
        return {shape_.levels, 0, 0};
    }

private:
    void read_leaves(std::span<const format::Triangle> triangles, ParallelFor parallel_for);

    const build::Bvh& bvh_;
    format::BvhShape shape_;
    kernels::BoxPlacement boxes_;
    kernels::LeafPlacement leaves_;
    std::vector<std::uint32_t> corner_numbers_;  ///< per leaf [corner][lane]
    std::vector<std::uint8_t> used_;             ///< per leaf, bit set of triangles
};

/// Collects pairs of leaves and tests their triangles many at a time.
class SelfWalk::Tree::Batch {
public:
    Batch(const Tree& tree, Workspace::Storage& scratch,
          const std::function<void(const SelfPair&)>& found)
        : tree_(tree), scratch_(scratch), found_(found) {
        scratch_.leaf_scratch.begin();
    }

    void add(std::uint32_t leaf_a, std::uint32_t leaf_b) {
        const BvhLeaf* leaves = tree_.bvh_.leaves.data();
        prefetch(&leaves[leaf_b]);
        assert(count_ < kernels::kLeafBatch);
        scratch_.leaf_pairs[count_++] = {leaves[leaf_a].corner[0][0].data(),
                                         leaves[leaf_b].corner[0][0].data(),
                                         leaf_a,
                                         leaf_b,
                                         tree_.used_[leaf_a],
                                         tree_.used_[leaf_b]};
        if (count_ == kernels::kLeafBatch) flush();
    }

    void flush() {
        const std::size_t contacts = kernels::active().find_own_contacts(
            tree_.leaves_, scratch_.leaf_pairs.data(), count_, tree_.corner_numbers_.data(),
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
    const Tree& tree_;
    Workspace::Storage& scratch_;
    const std::function<void(const SelfPair&)>& found_;
    std::size_t count_ = 0;
};

SelfWalk::Tree::Tree(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
                     ParallelFor parallel_for)
    : bvh_(bvh), shape_(format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size()))) {
    const PlacedBoxes placed = place_upon_itself(bvh.frame.origin, bvh.frame.exponent);
    boxes_ = placed.placement;
    leaves_ = place_leaves(bvh, placed);
    read_leaves(triangles, parallel_for);
}

void SelfWalk::Tree::read_leaves(std::span<const format::Triangle> triangles,
                                 ParallelFor parallel_for) {
    const std::size_t leaves = bvh_.leaves.size();
    corner_numbers_.resize(leaves * kNumbersPerLeaf);
    used_.resize(leaves);
    constexpr std::size_t kLeavesPerTask = 4096;
    const auto read = [&](std::size_t first, std::size_t last) {
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
    for_chunks(bvh_.order.size(), kLeavesPerTask * kBvhWidth, parallel_for, read);
}

template <class Step>
void SelfWalk::Tree::for_children(const NodePair& pair, Step&& step) const {
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

SelfWalk::SelfWalk(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
                   ParallelFor parallel_for) {
    const format::FloatEnvironment environment;
    tree_ = std::make_unique<const Tree>(bvh, triangles, parallel_for);
    if (bvh.order.empty()) return;
    starts_ = {tree_->root()};
    std::vector<NodePair> below;
    while (starts_.size() < kParts && starts_.front().height > 1) {
        below.clear();
        for (const NodePair& pair : starts_) {
            tree_->for_children(pair, [&](const NodePair& child) { below.push_back(child); });
        }
        starts_.swap(below);
    }
}

SelfWalk::~SelfWalk() = default;

std::size_t SelfWalk::part_count() const noexcept {
    return std::min(kParts, starts_.size());
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

void SelfWalk::run(Rest& rest, Workspace& workspace,
                   const std::function<void(const SelfPair&)>& found,
                   const std::function<bool(std::size_t)>& is_enough) const {
    format::FloatEnvironment environment;
    const std::function<void(const SelfPair&)> outside = [&](const SelfPair& pair) {
        environment.outside([&] { found(pair); });
    };
    Tree::Batch batch(*tree_, workspace.storage(), outside);
    // Visits the children of the next node pair.
    const auto step = [&] {
        const NodePair pair = rest.open_.back();
        rest.open_.pop_back();
        std::size_t work = 1;
        tree_->for_children(pair, [&](const NodePair& child) {
            if (child.height == 0) {
                batch.add(child.a, child.b);
                ++work;
            } else {
                rest.open_.push_back(child);
            }
        });
        return work;
    };
    bool enough = false;
    while (!rest.empty() && !enough) {
        const std::size_t work = step();
        enough = environment.outside([&] { return is_enough(work); });
    }
    batch.flush();
}

}  // namespace cdprep
