// SPDX-License-Identifier: MIT
#include "octree_search.h"

namespace cdprep {
namespace {

/// How many of `count` rising values are at most `limit`. The number of steps depends on
/// `count` alone and each step moves without a branch: where a point falls is a coin toss,
/// which no processor predicts.
template <class Value, class KeyOf>
std::size_t count_up_to(const Value* values, std::size_t count, std::uint64_t limit,
                        KeyOf key_of) noexcept {
    const Value* begin = values;
    while (count > 1) {
        const std::size_t half = count / 2;
        begin += key_of(begin[half - 1]) <= limit ? half : 0;
        count -= half;
    }
    const std::size_t last = count == 1 && key_of(*begin) <= limit ? 1 : 0;
    return static_cast<std::size_t>(begin - values) + last;
}

/// Leaves do not overlap, so the one that begins last before `code` or there holds it, if
/// any does: empty cells are not stored, and it may end before.
std::uint32_t find_sorted(const OctreeIndex& index, std::uint64_t code) noexcept {
    const std::uint64_t cell = code >> (3 * (format::kOctreeBits - index.top_level));
    const std::uint32_t first = index.top[cell];
    const std::size_t count = index.top[cell + 1] - first;
    const std::size_t before =
        first + count_up_to(index.leaf_codes.data() + first, count, code,
                            [](std::uint64_t leaf_code) { return leaf_code; });
    if (before == 0) return kNoNode;
    const std::uint32_t node = index.leaf_nodes[before - 1];
    const std::uint64_t key = index.nodes[node].key;
    return key_at(code, level_of(key)) == key ? node : kNoNode;
}

/// The deepest stored cell that holds `code` is a leaf, or an inner node whose child there
/// is empty.
template <class SlotOf>
std::uint32_t find_upwards(const OctreeIndex& index, std::span<const std::uint32_t> table,
                           std::uint64_t code, SlotOf slot_of) noexcept {
    for (std::uint64_t key = key_at(code, index.deepest); key != 0; key >>= 3) {
        const std::uint32_t node = find_chained(index, table, slot_of(key, index.slot_bits), key);
        if (node != kNoNode) return is_leaf(index.nodes[node]) ? node : kNoNode;
    }
    return kNoNode;
}

}  // namespace

OctreeIndex octree_index(const Model& model) noexcept {
    const auto nodes = model.octree_nodes();
    return {.top_level = model.octree_grid()->top_level,
            .slot_bits = model.octree_grid()->slot_bits,
            .deepest = nodes.empty() ? 0 : level_of(nodes.back().key),
            .nodes = nodes,
            .leaf_codes = model.octree_leaf_codes(),
            .leaf_nodes = model.octree_leaf_nodes(),
            .top = model.octree_top(),
            .modulus_table = model.octree_modulus_table(),
            .mixed_table = model.octree_mixed_table()};
}

OctreeIndex octree_index(const build::Octree& octree) noexcept {
    const auto& nodes = octree.nodes;
    return {.top_level = octree.grid.top_level,
            .slot_bits = octree.grid.slot_bits,
            .deepest = nodes.empty() ? 0 : level_of(nodes.back().key),
            .nodes = nodes,
            .leaf_codes = octree.leaf_codes,
            .leaf_nodes = octree.leaf_nodes,
            .top = octree.top,
            .modulus_table = octree.modulus_table,
            .mixed_table = octree.mixed_table};
}

std::uint32_t find_node_in_order(const OctreeIndex& index, std::uint64_t key) noexcept {
    const std::size_t before = count_up_to(index.nodes.data(), index.nodes.size(), key,
                                           [](const format::OctreeNode& node) { return node.key; });
    if (before == 0 || index.nodes[before - 1].key != key) return kNoNode;
    return static_cast<std::uint32_t>(before - 1);
}

std::uint32_t find_node(const OctreeIndex& index, CellSearch search, std::uint64_t key) noexcept {
    if (index.nodes.empty()) return kNoNode;
    switch (search) {
        case CellSearch::modulus:
            return find_chained(index, index.modulus_table, modulus_slot(key, index.slot_bits),
                                key);
        case CellSearch::mixed:
            return find_chained(index, index.mixed_table, mixed_slot(key, index.slot_bits), key);
        case CellSearch::sorted:
            break;
    }
    return find_node_in_order(index, key);
}

std::uint32_t find_leaf(const OctreeIndex& index, CellSearch search, std::uint64_t code) noexcept {
    if (index.nodes.empty()) return kNoNode;
    switch (search) {
        case CellSearch::modulus:
            return find_upwards(index, index.modulus_table, code, modulus_slot);
        case CellSearch::mixed:
            return find_upwards(index, index.mixed_table, code, mixed_slot);
        case CellSearch::sorted:
            break;
    }
    return find_sorted(index, code);
}

}  // namespace cdprep
