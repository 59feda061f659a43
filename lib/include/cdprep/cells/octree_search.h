// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/format/api.h"
#include "cdprep/format/octree.h"
#include "cdprep/model.h"

namespace cdprep {

/// The result of a search if no node has the key, or no leaf holds the point.
inline constexpr std::uint32_t kNoNode = 0xffffffffU;

/// The parts of a hashed octree that a search reads. They belong to a model or a builder, which
/// must outlive the index. A search is safe if format::find_damage() finds nothing. Then the
/// elements of `top` never decrease and end at the number of leaves. All numbers name nodes, and
/// every chain ends. If there are nodes, a search also reads the table of its CellSearch. Do not
/// use a CellSearch whose table is missing.
struct OctreeIndex {
    std::uint32_t top_level = 0;  ///< as in format::OctreeGrid
    std::uint32_t slot_bits = 0;
    std::uint32_t deepest = 0;  ///< level of the deepest nodes, which come last
    std::span<const format::OctreeNode> nodes;
    std::span<const std::uint64_t> leaf_codes;
    std::span<const std::uint32_t> leaf_nodes;
    std::span<const std::uint32_t> top;
    std::span<const std::uint32_t> modulus_table;
    std::span<const std::uint32_t> mixed_table;
};

/// Returns the index of a model that has octree().grid, or of a builder's octree. Without
/// triangles, its `nodes` are empty. If a model has no grid, the program stops with a message.
[[nodiscard]] CDPREP_API OctreeIndex octree_index(const Model& model) noexcept;
[[nodiscard]] CDPREP_API OctreeIndex octree_index(const build::Octree& octree) noexcept;

/// Returns the Z-order code of the finest cell that holds a point. If the point is outside the
/// cube, returns the code of the cell nearest to it. `p` has no NaN.
[[nodiscard]] CDPREP_API std::uint64_t code_of_point(const format::OctreeGrid& grid,
                                                     const Double3& p) noexcept;

/// Returns the key of the cell of `level` that contains the finest cell with Z-order code `code`.
inline std::uint64_t key_at(std::uint64_t code, std::uint32_t level) noexcept {
    assert(level <= format::kOctreeBits && code >> (3 * format::kOctreeBits) == 0);
    return (std::uint64_t{1} << (3 * level)) | (code >> (3 * (format::kOctreeBits - level)));
}

inline bool is_leaf(const format::OctreeNode& node) noexcept {
    return (node.count & format::kInnerNode) == 0;
}

/// Returns the node of a key in the chain that starts at a slot, or kNoNode. Takes O(length of the
/// chain) time.
inline std::uint32_t find_chained(const OctreeIndex& index, std::span<const std::uint32_t> table,
                                  std::uint64_t slot, std::uint64_t key) noexcept {
    assert(slot >> index.slot_bits == 0);
    assert(table.size() == (std::size_t{1} << index.slot_bits) + index.nodes.size());
    const std::uint32_t* next = table.data() + (std::size_t{1} << index.slot_bits);
    for (std::uint32_t entry = table[slot]; entry != 0; entry = next[entry - 1]) {
        assert(entry <= index.nodes.size());
        if (index.nodes[entry - 1].key == key) return entry - 1;
    }
    return kNoNode;
}

/// Returns the node of a key, or kNoNode, by bisection of the sorted nodes. Reads no table. Takes
/// O(log nodes) time. Independent searches overlap in the processor; they take five to nine times
/// as long as with a table. Searches that each depend on the one before take 0.8 to 2.6 times as
/// long (octree_top_bench).
inline std::uint32_t find_node_in_order(const OctreeIndex& index, std::uint64_t key) noexcept {
    const auto at = std::lower_bound(
        index.nodes.begin(), index.nodes.end(), key,
        [](const format::OctreeNode& node, std::uint64_t limit) { return node.key < limit; });
    if (at == index.nodes.end() || at->key != key) return kNoNode;
    return static_cast<std::uint32_t>(at - index.nodes.begin());
}

/// Returns the result of find_leaf(), found by binary search in the sorted leaves. The octree must
/// have nodes. Leaves do not overlap. So if a leaf holds `code`, it is the last one that begins at
/// or before `code`. That leaf may end before `code`, because empty cells are not stored.
inline std::uint32_t find_sorted_leaf(const OctreeIndex& index, std::uint64_t code) noexcept {
    const std::uint64_t cell = code >> (3 * (format::kOctreeBits - index.top_level));
    assert(cell + 1 < index.top.size());
    const std::uint64_t* const codes = index.leaf_codes.data();
    // This search uses branches. Mispredictions cost less than waiting, in each step, for a code
    // that is not in the caches (octree_top_bench).
    const std::uint64_t* const after =
        std::upper_bound(codes + index.top[cell], codes + index.top[cell + 1], code);
    if (after == codes) return kNoNode;
    const std::uint32_t node = index.leaf_nodes[static_cast<std::size_t>(after - codes) - 1];
    const std::uint64_t key = index.nodes[node].key;
    return key_at(code, format::level_of(key)) == key ? node : kNoNode;
}

/// Returns the result of find_leaf(), found in a chained hash table. The deepest stored cell that
/// holds `code` is a leaf, or an inner node whose child there is empty.
template <auto kSlotOf>
std::uint32_t find_chained_leaf(const OctreeIndex& index, std::span<const std::uint32_t> table,
                                std::uint64_t code) noexcept {
    for (std::uint64_t key = key_at(code, index.deepest); key != 0; key >>= 3) {
        const std::uint32_t node = find_chained(index, table, kSlotOf(key, index.slot_bits), key);
        if (node != kNoNode) return is_leaf(index.nodes[node]) ? node : kNoNode;
    }
    return kNoNode;
}

/// Returns the node of a key, or kNoNode. The node may be an inner node or a leaf. 0 is not the key
/// of any node. Uses the table that `search` names. With CellSearch::sorted, calls
/// find_node_in_order(), because sorted leaves do not include inner nodes.
inline std::uint32_t find_node(const OctreeIndex& index, CellSearch search,
                               std::uint64_t key) noexcept {
    if (index.nodes.empty()) return kNoNode;
    switch (search) {
        case CellSearch::modulus:
            return find_chained(index, index.modulus_table,
                                format::modulus_slot(key, index.slot_bits), key);
        case CellSearch::mixed:
            return find_chained(index, index.mixed_table, format::mixed_slot(key, index.slot_bits),
                                key);
        case CellSearch::sorted:
            break;
    }
    return find_node_in_order(index, key);
}

/// Returns the leaf whose half-open cell contains the finest cell with Z-order code `code`. `code`
/// is below 2^63. Returns kNoNode if there is no such leaf, because no triangle touches the space
/// there. Every CellSearch gives the same answer, that of a descent from the root.
/// CellSearch::sorted takes O(log n) time for n leaves in one cell of top_level. The others go up
/// from the deepest level and search one chain at each level, up to the level of the answer.
inline std::uint32_t find_leaf(const OctreeIndex& index, CellSearch search,
                               std::uint64_t code) noexcept {
    if (index.nodes.empty()) return kNoNode;
    switch (search) {
        case CellSearch::modulus:
            return find_chained_leaf<format::modulus_slot>(index, index.modulus_table, code);
        case CellSearch::mixed:
            return find_chained_leaf<format::mixed_slot>(index, index.mixed_table, code);
        case CellSearch::sorted:
            break;
    }
    return find_sorted_leaf(index, code);
}

}  // namespace cdprep
