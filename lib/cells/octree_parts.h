// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>

#include "cdprep/cells/octree_search.h"
#include "cells/cell_bounds.h"
#include "cells/octree_cells.h"

namespace cdprep {

/// The contents of one cell in an octree: a run of its sorted leaves or, from a table, one node.
/// Empty where no triangle touches the cell.
struct OctreePart {
    std::uint32_t first = 0;
    std::uint32_t last = 0;  ///< one past

    [[nodiscard]] bool empty() const noexcept {
        return first == last;
    }
    friend bool operator==(const OctreePart&, const OctreePart&) = default;
};

/// Finds the part of any cell directly by its key, and goes down from there.
class OctreeParts {
public:
    OctreeParts(const OctreeIndex& index, std::span<const std::uint32_t> references,
                CellSearch search) noexcept
        : index_(index), references_(references), search_(search) {}

    /// Returns the deepest level at which cells have parts of their own.
    [[nodiscard]] std::uint32_t deepest() const noexcept {
        return index_.deepest;
    }

    /// Returns the part of the cell of `level` that begins with the finest cell `code`: its
    /// contents, or the leaf that holds it. `level` is at most deepest(). There must be nodes.
    [[nodiscard]] OctreePart at(std::uint64_t code, std::uint32_t level) const noexcept {
        assert(!index_.nodes.empty() && level <= deepest());
        switch (search_) {
            case CellSearch::modulus:
                return chained(index_.modulus_table, code, level, format::modulus_slot);
            case CellSearch::mixed:
                return chained(index_.mixed_table, code, level, format::mixed_slot);
            case CellSearch::sorted:
                break;
        }
        return run(code, level);
    }

    /// Returns whether a part that is not empty is one leaf.
    [[nodiscard]] bool is_single_leaf(const OctreePart& part) const noexcept {
        assert(!part.empty());
        if (search_ == CellSearch::sorted) return part.last - part.first == 1;
        return is_leaf(index_.nodes[part.first]);
    }

    /// Returns the triangles of one leaf.
    [[nodiscard]] std::span<const std::uint32_t> references(const OctreePart& leaf) const noexcept {
        const format::OctreeNode& node = index_.nodes[node_of(leaf)];
        assert(is_leaf(node));
        return references_.subspan(node.first, node.count);
    }
    /// Returns the number of a part that is one node.
    [[nodiscard]] std::uint32_t node_of(const OctreePart& part) const noexcept {
        assert(!part.empty() && is_node(part));
        return search_ == CellSearch::sorted ? index_.leaf_nodes[part.first] : part.first;
    }

    /// Returns whether a part that is not empty is one node.
    [[nodiscard]] bool is_node(const OctreePart& part) const noexcept {
        return search_ != CellSearch::sorted || part.last - part.first == 1;
    }

    /// Returns a bit for each child that may have a part. The given part is not a leaf.
    [[nodiscard]] unsigned children(const OctreePart& part) const noexcept {
        return search_ == CellSearch::sorted ? 0xff : index_.nodes[part.first].count & 0xff;
    }
    /// Returns whether the i-th child's part, as child() returns it, is not empty.
    [[nodiscard]] bool has_child(const OctreePart& part, unsigned i, std::uint64_t code,
                                 std::uint32_t level) const noexcept {
        if (search_ != CellSearch::sorted) {
            return (index_.nodes[part.first].count >> i & 1) != 0;
        }
        const std::uint32_t first =
            i == 0 ? part.first : leaves_up_to(part.first, part.last, code - 1);
        return first < part.last && index_.leaf_codes[first] - code < cells_below(level);
    }
    /// Returns the part of the i-th child, which is one of children(): a cell of `level` that
    /// begins with the finest cell `code`.
    [[nodiscard]] OctreePart child(const OctreePart& part, unsigned i, std::uint64_t code,
                                   std::uint32_t level) const noexcept {
        if (search_ != CellSearch::sorted) {
            const format::OctreeNode& node = index_.nodes[part.first];
            assert(!is_leaf(node) && (node.count >> i & 1) != 0);
            const std::uint32_t at = node.first + lanes_before(node.count & 0xff, i);
            return {at, at + 1};
        }
        const std::uint32_t first =
            i == 0 ? part.first : leaves_up_to(part.first, part.last, code - 1);
        const std::uint32_t last =
            i == 7 ? part.last : leaves_up_to(first, part.last, code + (cells_below(level) - 1));
        return {first, last};
    }

private:
    [[nodiscard]] std::uint32_t leaves_up_to(std::uint32_t first, std::uint32_t last,
                                             std::uint64_t code) const noexcept {
        assert(first <= last && last <= index_.leaf_codes.size());
        const std::uint64_t* codes = index_.leaf_codes.data();
        const std::uint64_t* end = std::upper_bound(codes + first, codes + last, code);
        return static_cast<std::uint32_t>(end - codes);
    }

    /// Returns the leaves that begin in the cell; if there are none, the leaf before them if it
    /// holds the cell.
    [[nodiscard]] OctreePart run(std::uint64_t code, std::uint32_t level) const noexcept {
        const std::uint32_t shift = 3 * (format::kOctreeBits - index_.top_level);
        const std::uint64_t last_code = code + (cells_below(level) - 1);
        OctreePart part{index_.top[code >> shift], index_.top[(last_code >> shift) + 1]};
        if (level > index_.top_level && !part.empty()) {
            const std::uint32_t end = leaves_up_to(part.first, part.last, last_code);
            part = {code == 0 ? 0 : leaves_up_to(part.first, end, code - 1), end};
        }
        if (!part.empty() || part.first == 0) return part;
        const std::uint64_t key = index_.nodes[index_.leaf_nodes[part.first - 1]].key;
        const bool holds = key_at(code, level_of(key)) == key;
        return holds ? OctreePart{part.first - 1, part.first} : OctreePart{};
    }

    template <class SlotOf>
    [[nodiscard]] OctreePart chained(std::span<const std::uint32_t> table, std::uint64_t code,
                                     std::uint32_t level, SlotOf slot_of) const noexcept {
        const std::uint64_t own = key_at(code, level);
        for (std::uint64_t key = own; key != 0; key >>= 3) {
            const std::uint32_t node =
                find_chained(index_, table, slot_of(key, index_.slot_bits), key);
            if (node == kNoNode) continue;
            // An inner node above the cell means that its child there is empty.
            const bool holds = key == own || is_leaf(index_.nodes[node]);
            return holds ? OctreePart{node, node + 1} : OctreePart{};
        }
        return {};
    }

    OctreeIndex index_;
    std::span<const std::uint32_t> references_;
    CellSearch search_;
};

}  // namespace cdprep
