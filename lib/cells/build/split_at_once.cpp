// SPDX-License-Identifier: MIT
#include "cells/build/tetra_steps.h"

#include <bit>
#include <cassert>

#include "build/chunks.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/octree.h"

namespace cdprep::build {
namespace {

constexpr std::uint16_t kSeveral = 0xffff;  ///< instead of one cone's number: see `several`

/// The results of one task for its triangles.
struct Chunk {
    std::vector<std::uint32_t> place;    ///< by cone: counts, then the place of the next one
    std::vector<std::uint16_t> several;  ///< for each that is not in one: count, then cones
    std::vector<std::uint32_t> centre;
};

class Splitter {
public:
    Splitter(const TetraInput& input, const std::uint32_t* home, std::uint32_t level)
        : input_(input),
          home_(home),
          level_(level),
          cones_(format::tetra_cones(level)),
          cone_(std::make_unique_for_overwrite<std::uint16_t[]>(input.triangles.size())),
          chunks_((input.triangles.size() + kItemsPerTask - 1) / kItemsPerTask) {}

    ConeLists split(ParallelFor parallel_for) {
        const std::size_t count = input_.triangles.size();
        for_chunks(count, kItemsPerTask, parallel_for,
                   [&](std::size_t first, std::size_t last) { find_cones(first, last); });
        ConeLists lists;
        share_out(lists);
        for_chunks(count, kItemsPerTask, parallel_for, [&](std::size_t first, std::size_t last) {
            move(first, last, lists.items.get());
        });
        return lists;
    }

private:
    /// Finds the cones below one that a triangle touches.
    class Descent {
    public:
        Descent(const TetraInput& input, std::uint32_t level)
            : input_(input), level_(level), children_(format::tetra_cones(level)) {}

        /// Adds the numbers of the touched cones of the level, rising. The triangle touches `key`.
        void descend(std::uint32_t key, std::uint32_t triangle, bool in_octant,
                     std::vector<std::uint16_t>& cones) {
            const bool is_root = key == kRootKey;
            assert(is_root || tetra_level(key) <= level_);
            if (!is_root && tetra_level(key) == level_) {
                cones.push_back(static_cast<std::uint16_t>(key - format::tetra_cones(level_)));
                return;
            }
            std::unique_ptr<ConeChildren>& children = children_[key];
            if (!children) children = std::make_unique<ConeChildren>(input_, key);
            std::uint32_t mask = children->touched_by(triangle, in_octant);
            for (; mask != 0; mask &= mask - 1) {
                const auto child = static_cast<std::uint32_t>(std::countr_zero(mask));
                descend(key << (is_root ? 3 : 2) | child, triangle, in_octant, cones);
            }
        }

    private:
        const TetraInput& input_;
        std::uint32_t level_;
        std::vector<std::unique_ptr<ConeChildren>> children_;  ///< by key, made on first use
    };

    void find_cones(std::size_t first, std::size_t last) {
        Chunk& chunk = chunks_[first / kItemsPerTask];
        chunk.place.assign(cones_, 0);
        Descent descent(input_, level_);
        const int finest = std::bit_width(cones_);
        for (std::size_t i = first; i < last; ++i) {
            const int below = std::bit_width(home_[i]) - finest;
            if (below >= 0) {
                const std::uint32_t cone = (home_[i] >> below) - cones_;
                assert(cone < cones_);
                cone_[i] = static_cast<std::uint16_t>(cone);
                ++chunk.place[cone];
            } else {
                find_several(static_cast<std::uint32_t>(i), descent, chunk);
            }
        }
    }

    void find_several(std::uint32_t triangle, Descent& descent, Chunk& chunk) {
        std::vector<std::uint16_t>& several = chunk.several;
        const std::size_t begin = several.size();
        const std::uint32_t home = home_[triangle];
        several.push_back(0);
        descent.descend(home == 0 ? kRootKey : home, triangle, home != 0, several);
        const std::size_t count = several.size() - begin - 1;
        assert(count <= cones_);
        several[begin] = static_cast<std::uint16_t>(count);
        cone_[triangle] = kSeveral;
        for (std::size_t i = begin + 1; i < several.size(); ++i) ++chunk.place[several[i]];
        if (count == 0) chunk.centre.push_back(triangle);
    }

    /// Turns counts into places.
    void share_out(ConeLists& lists) {
        std::size_t end = 0;
        for (std::uint32_t cone = 0; cone < cones_; ++cone) {
            lists.first.push_back(end);
            for (Chunk& chunk : chunks_) {
                const std::uint32_t count = chunk.place[cone];
                chunk.place[cone] = static_cast<std::uint32_t>(end);
                end += count;
            }
        }
        lists.first.push_back(end);
        lists.items = std::make_unique_for_overwrite<std::uint32_t[]>(end);
        for (const Chunk& chunk : chunks_) {
            lists.centre.insert(lists.centre.end(), chunk.centre.begin(), chunk.centre.end());
        }
    }

    void move(std::size_t first, std::size_t last, std::uint32_t* items) {
        Chunk& chunk = chunks_[first / kItemsPerTask];
        std::size_t next = 0;
        for (std::size_t i = first; i < last; ++i) {
            const auto triangle = static_cast<std::uint32_t>(i);
            if (cone_[i] != kSeveral) {
                items[chunk.place[cone_[i]]++] = triangle;
                continue;
            }
            const std::size_t count = chunk.several[next++];
            const std::uint32_t item = count > 1 ? triangle | format::kSharedReference : triangle;
            for (const std::size_t end = next + count; next < end; ++next) {
                items[chunk.place[chunk.several[next]]++] = item;
            }
        }
    }

    const TetraInput& input_;
    const std::uint32_t* home_;
    std::uint32_t level_;
    std::uint32_t cones_;
    std::unique_ptr<std::uint16_t[]> cone_;  ///< per triangle
    std::vector<Chunk> chunks_;
};

}  // namespace

ConeLists split_at_once(const TetraInput& input, const std::uint32_t* home, std::uint32_t level,
                        ParallelFor parallel_for) {
    assert(level <= kMostLevelAtOnce);
    return Splitter(input, home, level).split(parallel_for);
}

}  // namespace cdprep::build
