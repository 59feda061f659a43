// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// Two triangles of one hierarchy, in tree order, a < b.
struct SelfPair {
    std::uint32_t a;
    std::uint32_t b;
    bool certain;  ///< proved: they cross; else they may be apart
};

/// A walk of a hierarchy against itself. Every pair of triangles without a common vertex that
/// cross or touch is among those found, each once, and few pairs that do neither. Exact tests of
/// the pairs are the caller's (exact/triangles.h).
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

    /// `bvh` was built over `triangles` with BvhBounds::aligned; it outlives the walk. Allocates
    /// 25 bytes a triangle.
    SelfWalk(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
             ParallelFor parallel_for);
    SelfWalk(const SelfWalk&) = delete;
    SelfWalk& operator=(const SelfWalk&) = delete;
    ~SelfWalk();

    /// Returns the number of parts of the walk, at most 128; it does not depend on threads.
    [[nodiscard]] std::size_t part_count() const noexcept;

    /// Returns all of a part, below part_count().
    [[nodiscard]] Rest part(std::size_t number) const;

    /// Calls `found` for each pair of a part's rest, until that is empty or `is_enough` returns
    /// true. `is_enough` is asked after each step with the number of node pairs and leaf pairs of
    /// that step, at most 65. Parts may run at once, each with its own workspace. Interruptions do
    /// not change the pairs.
    void run(Rest& rest, Workspace& workspace, const std::function<void(const SelfPair&)>& found,
             const std::function<bool(std::size_t)>& is_enough) const;

private:
    class Tree;

    std::unique_ptr<const Tree> tree_;
    std::vector<NodePair> starts_;  ///< of all parts, one after the other
};

}  // namespace cdprep
