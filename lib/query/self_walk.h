// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Two triangles of one tree, tree order, a < b.
struct SelfPair {
    std::uint32_t a;
    std::uint32_t b;
    bool certain;  ///< their insides cross; else the exact decision is to be made
};

/// Walks a tree against itself: every pair of triangles without a common vertex that
/// cross or touch is among those found, each once, and few that do neither.
class SelfWalk {
    /// Two nodes of one height, a <= b. Those of height 0 are leaves.
    struct NodePair {
        std::uint32_t height;
        std::uint32_t a;
        std::uint32_t b;
    };

public:
    /// What is left to do of a part of the walk.
    class Rest {
    public:
        [[nodiscard]] bool empty() const noexcept {
            return open_.empty();
        }

    private:
        friend class SelfWalk;
        std::vector<NodePair> open_;  ///< the next one last
    };

    /// The tree must outlive the walk. `triangles` are those it was built over.
    SelfWalk(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
             ParallelFor parallel_for);

    /// How many parts the walk has; the same for any parallel_for.
    [[nodiscard]] std::size_t part_count() const noexcept;

    /// All of a part.
    [[nodiscard]] Rest part(std::size_t number) const;

    /// Calls `found` for each pair of a part's rest, until that is empty or `is_enough`
    /// returns true. Asks it after each step, with the number of node pairs and leaf pairs
    /// that the step looked at, at most 65. Parts may run at once, each with a scratch of
    /// its own. The pairs do not depend on where a part was interrupted.
    void run(Rest& rest, Workspace::Storage& scratch,
             const std::function<void(const SelfPair&)>& found,
             const std::function<bool(std::size_t)>& is_enough) const;

private:
    class Batch;

    void read_leaves(std::span<const format::Triangle> triangles, ParallelFor parallel_for);

    /// Calls step(pair) for each pair of children whose boxes overlap.
    template <class Step>
    void for_children(const NodePair& pair, Step&& step) const;
    std::size_t step(Rest& rest, Batch& batch) const;
    void find_starts();

    const build::Bvh& bvh_;
    format::BvhShape shape_;
    kernels::BoxPlacement boxes_;
    kernels::LeafPlacement leaves_;
    std::vector<std::uint32_t> corner_numbers_;  ///< per leaf [corner][lane]
    std::vector<std::uint8_t> used_;             ///< per leaf, bit set of triangles
    std::vector<NodePair> starts_;               ///< of all parts, one after the other
};

}  // namespace cdprep
