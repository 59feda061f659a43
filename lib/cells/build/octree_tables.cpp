// SPDX-License-Identifier: MIT
#include "cells/build/octree_steps.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "cells/octree_cells.h"

namespace cdprep::build {
namespace {

using format::kInnerNode;
using format::OctreeNode;

/// The maximum level of the top table, 1 MiB, and its cells per leaf. Both were measured by
/// octree_top_bench on octrees of 14,000 to 2,200,000 leaves. A finer table saves steps in cells
/// that are full, as near the surface. Where most cells are empty, however, the table misses the
/// caches: one level more takes up to three times as long there.
constexpr std::uint32_t kMostTopLevel = 6;
constexpr std::uint64_t kTopCellsPerLeaf = 2;

/// A walk of the tree along the Z-order curve, children in order. The levels are stored one after
/// another, so the next node of each level is the one after the last.
class LeafWalk {
public:
    explicit LeafWalk(Octree& octree) : octree_(octree) {}

    void add_below(std::uint32_t number) {
        const OctreeNode& node = octree_.nodes[number];
        if ((node.count & kInnerNode) == 0) {
            assert(octree_.leaf_codes.empty() || octree_.leaf_codes.back() < code_of(node.key));
            octree_.leaf_codes.push_back(code_of(node.key));
            octree_.leaf_nodes.push_back(number);
            return;
        }
        const auto children = static_cast<std::uint32_t>(std::popcount(node.count & 0xff));
        for (std::uint32_t i = 0; i < children; ++i) add_below(node.first + i);
    }

private:
    Octree& octree_;
};

void make_top(Octree& octree) {
    const std::size_t leaves = octree.leaf_codes.size();
    std::uint32_t level = std::min(octree.grid.level, kMostTopLevel);
    while (level > 0 && (std::uint64_t{1} << (3 * level)) > kTopCellsPerLeaf * leaves) --level;
    octree.grid.top_level = level;
    const std::uint64_t cells = std::uint64_t{1} << (3 * level);
    octree.top.resize(cells + 1);
    std::uint32_t leaf = 0;
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
        const std::uint64_t code = cell * cells_below(level);
        while (leaf < leaves && octree.leaf_codes[leaf] < code) ++leaf;
        octree.top[cell] = leaf;
    }
    octree.top[cells] = static_cast<std::uint32_t>(leaves);
}

/// Returns the nodes chained by slot. They are added from the last to the first, each before those
/// of its slot. So numbers rise along every chain, which proves that it ends.
template <class Slot>
std::vector<std::uint32_t> chained(const Octree& octree, const Slot& slot) {
    const std::size_t slots = std::size_t{1} << octree.grid.slot_bits;
    std::vector<std::uint32_t> table(slots + octree.nodes.size());
    for (std::size_t i = octree.nodes.size(); i-- > 0;) {
        assert(slot(octree.nodes[i].key) < slots);
        std::uint32_t& first = table[slot(octree.nodes[i].key)];
        table[slots + i] = first;
        first = static_cast<std::uint32_t>(i + 1);
    }
    return table;
}

}  // namespace

void make_octree_tables(Octree& octree) {
    if (!octree.nodes.empty()) LeafWalk(octree).add_below(0);
    make_top(octree);
    // At least two slots per node.
    const std::uint32_t bits = std::bit_width(std::max<std::size_t>(octree.nodes.size(), 1)) + 1;
    octree.grid.slot_bits = bits;
    octree.modulus_table =
        chained(octree, [=](std::uint64_t key) { return format::modulus_slot(key, bits); });
    octree.mixed_table =
        chained(octree, [=](std::uint64_t key) { return format::mixed_slot(key, bits); });
}

}  // namespace cdprep::build
