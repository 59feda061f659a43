// SPDX-License-Identifier: MIT
#include "cdprep/advanced/self_walk.h"

#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "cdprep/precondition.h"
#include "core/guarded_for.h"
#include "walk/box_placement.h"
#include "walk/leaf_batch.h"
#include "walk/self_pairs.h"
#include "walk/workspace_storage.h"

namespace cdprep {
namespace {

using format::kBvhWidth;

constexpr std::size_t kNumbersPerLeaf = std::size_t{3} * kBvhWidth;

/// Enough for a team of threads to share evenly, and few enough for a scratch each.
constexpr std::size_t kParts = 128;

}  // namespace

/// The hierarchy as the walk reads it.
class SelfWalk::Tree {
public:
    Tree(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
         ParallelFor parallel_for);

    /// Calls step(pair) for each pair of children whose boxes overlap.
    template <class Step>
    void for_children(const NodePair& pair, Step&& step) const {
        boxes_.for_children(pair.height, pair.a, pair.b, [&](std::uint32_t a, std::uint32_t b) {
            step(NodePair{pair.height - 1, a, b});
        });
    }

    [[nodiscard]] NodePair root() const noexcept {
        return {boxes_.levels(), 0, 0};
    }
    [[nodiscard]] LeafBatch batch(Workspace::Storage& scratch) const noexcept {
        return {bvh_, placed_, scratch};
    }
    /// Returns the numbers of a leaf's vertices: [corner][lane].
    [[nodiscard]] const std::uint32_t* numbers_of(std::uint32_t leaf) const noexcept {
        return corner_numbers_.data() + leaf * kNumbersPerLeaf;
    }

private:
    void read_leaves(std::span<const format::Triangle> triangles, ParallelFor parallel_for);

    const build::Bvh& bvh_;
    PlacedBoxes placed_;
    SelfBoxes boxes_;
    std::vector<std::uint32_t> corner_numbers_;  ///< per leaf [corner][lane]
};

SelfWalk::Tree::Tree(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
                     ParallelFor parallel_for)
    : bvh_(bvh),
      placed_(place_upon_itself(bvh.frame.origin, bvh.frame.exponent)),
      boxes_(bvh.nodes.data(), format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size())),
             placed_.placement) {
    read_leaves(triangles, parallel_for);
}

void SelfWalk::Tree::read_leaves(std::span<const format::Triangle> triangles,
                                 ParallelFor parallel_for) {
    corner_numbers_.resize(bvh_.leaves.size() * kNumbersPerLeaf);
    constexpr std::size_t kLeavesPerTask = 4096;
    const auto read = [&](std::size_t first, std::size_t last) {
        for (std::size_t at = first; at < last; ++at) {
            const std::uint32_t triangle = bvh_.order[at];
            const std::size_t leaf = at / kBvhWidth, lane = at % kBvhWidth;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                corner_numbers_[leaf * kNumbersPerLeaf + corner * kBvhWidth + lane] =
                    triangles[triangle].vertex[corner];
            }
        }
    };
    for_chunks(bvh_.order.size(), kLeavesPerTask * kBvhWidth, parallel_for, read);
}

SelfWalk::SelfWalk(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
                   ParallelFor parallel_for) {
    if (bvh.order.size() != triangles.size()) {
        stop_with("The BVH was not built over these triangles: their numbers differ.");
    }
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, parallel_for);
    tree_ = std::make_unique<const Tree>(bvh, triangles, guarded);
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
    if (number >= part_count()) stop_with("The walk has no part with this number.");
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
    const auto outside = [&](std::uint32_t at_a, std::uint32_t at_b, bool certain) {
        const SelfPair pair = {at_a, at_b, certain};
        environment.outside([&] { found(pair); });
        return true;
    };
    LeafBatch batch = tree_->batch(workspace.storage());
    // Visits the children of the next node pair.
    const auto step = [&] {
        const NodePair pair = rest.open_.back();
        rest.open_.pop_back();
        std::size_t work = 1;
        tree_->for_children(pair, [&](const NodePair& child) {
            if (child.height > 0) {
                rest.open_.push_back(child);
                return;
            }
            batch.add(child.a, child.b, {tree_->numbers_of(child.a), tree_->numbers_of(child.b)});
            if (batch.full()) batch.flush_own(outside);
            ++work;
        });
        return work;
    };
    bool enough = false;
    while (!rest.empty() && !enough) {
        const std::size_t work = step();
        enough = environment.outside([&] { return is_enough(work); });
    }
    batch.flush_own(outside);
}

}  // namespace cdprep
