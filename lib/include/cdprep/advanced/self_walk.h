// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/api.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// Two triangles of one BVH, by their places in tree order; a < b.
struct SelfPair {
    std::uint32_t a;
    std::uint32_t b;
    bool certain;  ///< proven: they cross; otherwise they may be apart
};

/// A walk of a BVH against itself. It finds every pair of triangles that cross or touch and share
/// no vertex, each once. It also finds a few pairs that neither cross nor touch. The caller tests
/// the pairs exactly (exact/triangles.h).
class SelfWalk {
    /// Two nodes of one height, a <= b. Nodes of height 0 are leaves.
    struct NodePair {
        std::uint32_t height;
        std::uint32_t a;
        std::uint32_t b;
    };

public:
    /// The unfinished rest of a part of the walk.
    class Rest {
    public:
        [[nodiscard]] bool empty() const noexcept {
            return open_.empty();
        }

    private:
        friend class SelfWalk;
        std::vector<NodePair> open_;  ///< node pairs to visit; the last is visited next
    };

    /// Prepares a walk of `bvh`, which must be built over `triangles` with BvhBounds::aligned and
    /// must outlive the walk. Allocates about 12 bytes per triangle.
    CDPREP_API SelfWalk(const build::Bvh& bvh, std::span<const format::Triangle> triangles,
                        ParallelFor parallel_for);
    SelfWalk(const SelfWalk&) = delete;
    SelfWalk& operator=(const SelfWalk&) = delete;
    CDPREP_API ~SelfWalk();

    /// Returns the number of parts of the walk, at most 128. It does not depend on the number of
    /// threads.
    [[nodiscard]] CDPREP_API std::size_t part_count() const noexcept;

    /// Returns part `number` before any work on it. `number` must be below part_count(): otherwise
    /// the program stops with a message.
    [[nodiscard]] CDPREP_API Rest part(std::size_t number) const;

    /// Calls `found` for each pair of a part's rest, until the rest is empty or `is_enough` returns
    /// true. After each step, `is_enough` receives the number of node pairs and leaf pairs of that
    /// step, at most 65. Parts may run at once, each with its own workspace. Interruptions do not
    /// change which pairs are found.
    CDPREP_API void run(Rest& rest, Workspace& workspace,
                        const std::function<void(const SelfPair&)>& found,
                        const std::function<bool(std::size_t)>& is_enough) const;

private:
    class Tree;

    std::unique_ptr<const Tree> tree_;
    std::vector<NodePair> starts_;  ///< the first node pairs of all parts, part by part
};

}  // namespace cdprep
