// SPDX-License-Identifier: MIT
#include "section_checks.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "cdprep/format/content_hash.h"
#include "cdprep/format/octree.h"
#include "cell_boxes.h"
#include "reference_lists.h"

// Nodes are stored level by level, so the children of each follow those of the one before. So one
// pass with one counter proves that every node is reached once. The same holds for the references
// of leaves. Keys that continue their parents' keys end at level 21 by themselves.

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;
using Bytes = std::span<const std::byte>;

constexpr std::array kTreeIds = {SectionId::octree_grid, SectionId::octree_nodes,
                                 SectionId::octree_references};
constexpr std::array kTableIds = {SectionId::octree_leaf_codes, SectionId::octree_leaf_nodes,
                                  SectionId::octree_top, SectionId::octree_modulus_table,
                                  SectionId::octree_mixed_table};

bool is_leaf(const OctreeNode& node) noexcept {
    return (node.count & kInnerNode) == 0;
}

/// The wanted sections of an octree.
struct Parts {
    SectionView<OctreeGrid> grid;
    SectionView<OctreeNode> nodes;
    SectionView<std::uint32_t> references;
    SectionView<std::uint64_t> leaf_codes;
    SectionView<std::uint32_t> leaf_nodes;
    SectionView<std::uint32_t> top;
    std::uint64_t triangle_count;
    std::uint64_t leaf_count = 0;

    Parts(Bytes file, SectionSet wanted) noexcept
        : grid(file, SectionId::octree_grid, wanted),
          nodes(file, SectionId::octree_nodes, wanted),
          references(file, SectionId::octree_references, wanted),
          leaf_codes(file, SectionId::octree_leaf_codes, wanted),
          leaf_nodes(file, SectionId::octree_leaf_nodes, wanted),
          top(file, SectionId::octree_top, wanted),
          triangle_count(read_header(file).triangle_count) {}
};

/// Returns whether planes are finite and rise strictly: a step is at least two ulp of the farthest.
bool has_planes(const OctreeGrid& grid) noexcept {
    constexpr double kSteps = 1U << kOctreeBits;
    constexpr double kFarthest = 4 * kMaxCoordinate;
    constexpr double kTwoUlp = 0x1p-51;
    double farthest = 0;
    for (const double x : {grid.origin.x, grid.origin.y, grid.origin.z}) {
        if (!(std::fabs(x) <= kFarthest)) return false;
        farthest = std::max({farthest, std::fabs(x), std::fabs(x + grid.step * kSteps)});
    }
    if (!(grid.step > 0 && farthest <= kFarthest && grid.step >= kTwoUlp * farthest)) return false;
    int exponent = 0;
    const double bits = std::ldexp(std::frexp(grid.step, &exponent), 32);
    return bits == std::floor(bits);
}

Found find_bad_grid(const Parts& parts) noexcept {
    if (parts.grid.count() != 1) {
        return parts.grid.damage(DamageKind::bad_count, 0, parts.grid.count(), 1);
    }
    const OctreeGrid grid = parts.grid[0];
    if (!has_planes(grid)) return parts.grid.damage(DamageKind::bad_number, 0, 0, 0);
    const auto limited = [&](std::uint64_t found, std::uint64_t limit) -> Found {
        if (found <= limit) return std::nullopt;
        return parts.grid.damage(DamageKind::bad_index, 0, found, limit);
    };
    constexpr std::uint32_t kMostSlotBits = 40;
    if (const Found damage = limited(grid.level, kOctreeBits)) return damage;
    if (const Found damage = limited(grid.top_level, grid.level)) return damage;
    return limited(grid.slot_bits, kMostSlotBits);
}

/// The places where the next node's children and references begin.
struct Next {
    std::uint64_t child = 1;
    std::uint64_t reference = 0;
};

Found find_bad_inner(const Parts& parts, std::uint64_t i, const OctreeNode& node,
                     Next& next) noexcept {
    const auto bad = [&](std::uint64_t found, std::uint64_t limit) {
        return parts.nodes.damage(DamageKind::bad_order, i, found, limit);
    };
    const std::uint32_t level = level_of(node.key);
    const std::uint32_t children = node.count & 0xff;
    if (level >= parts.grid[0].level) return bad(level, parts.grid[0].level);
    if (node.count != (kInnerNode | children) || children == 0) return bad(node.count, 0);
    if (node.first != next.child) return bad(node.first, next.child);
    for (std::uint64_t child = 0; child < 8; ++child) {
        if ((children >> child & 1) == 0) continue;
        if (next.child >= parts.nodes.count()) return bad(next.child, parts.nodes.count() - 1);
        const std::uint64_t key = parts.nodes[next.child].key;
        if (key != (node.key << 3 | child)) {
            return parts.nodes.damage(DamageKind::bad_order, next.child, key,
                                      node.key << 3 | child);
        }
        ++next.child;
    }
    return std::nullopt;
}

Found find_bad_leaf(const Parts& parts, std::uint64_t i, const OctreeNode& node,
                    Next& next) noexcept {
    if (node.first != next.reference) {
        return parts.nodes.damage(DamageKind::bad_order, i, node.first, next.reference);
    }
    assert(next.reference <= parts.references.count());
    const std::uint64_t room = parts.references.count() - next.reference;
    if (node.count == 0 || node.count > room) {
        return parts.nodes.damage(DamageKind::bad_order, i, node.count, room);
    }
    next.reference += node.count;
    return find_bad_list(parts.references, node.first, node.count, parts.triangle_count);
}

Found find_bad_tree(Parts& parts) noexcept {
    const std::uint64_t count = parts.nodes.count();
    if ((count == 0) != (parts.triangle_count == 0)) {
        return parts.nodes.damage(DamageKind::bad_count, 0, count, parts.triangle_count);
    }
    if (count > 0 && parts.nodes[0].key != 1) {
        return parts.nodes.damage(DamageKind::bad_order, 0, parts.nodes[0].key, 1);
    }
    Next next;
    for (std::uint64_t i = 0; i < count; ++i) {
        // Node i is not the child of any node: its key was not compared with a parent's.
        if (i >= next.child) return parts.nodes.damage(DamageKind::bad_order, i, i, next.child - 1);
        const OctreeNode node = parts.nodes[i];
        const Found damage = is_leaf(node) ? find_bad_leaf(parts, i, node, next)
                                           : find_bad_inner(parts, i, node, next);
        if (damage) return damage;
        parts.leaf_count += is_leaf(node) ? 1 : 0;
    }
    if (next.reference == parts.references.count()) return std::nullopt;
    return parts.references.damage(DamageKind::bad_count, 0, parts.references.count(),
                                   next.reference);
}

/// Finds damage in the sorted leaves. Every leaf must be there once, in Z-order. Each has its code,
/// and codes rise.
Found find_bad_sorted_leaf(const Parts& parts) noexcept {
    for (const auto* entry : {&parts.leaf_codes.entry, &parts.leaf_nodes.entry}) {
        if (entry->count != parts.leaf_count) {
            return Damage{DamageKind::bad_count, entry->id, entry->offset, entry->count,
                          parts.leaf_count};
        }
    }
    std::uint64_t least = 0;
    for (std::uint64_t i = 0; i < parts.leaf_count; ++i) {
        const std::uint32_t number = parts.leaf_nodes[i];
        if (number >= parts.nodes.count()) {
            return parts.leaf_nodes.bad_index(i, number, parts.nodes.count());
        }
        const OctreeNode node = parts.nodes[number];
        if (!is_leaf(node)) return parts.leaf_nodes.damage(DamageKind::bad_order, i, number, 0);
        const std::uint64_t code = parts.leaf_codes[i];
        if (code < least || code != code_of(node.key)) {
            return parts.leaf_codes.damage(DamageKind::bad_order, i, code, code_of(node.key));
        }
        least = code + 1;
    }
    return std::nullopt;
}

/// Finds a wrong number of leaves before a cell. The codes on either side prove the number.
Found find_bad_top(const Parts& parts) noexcept {
    const std::uint32_t level = parts.grid[0].top_level;
    assert(level <= kOctreeBits);
    const std::uint64_t cells = std::uint64_t{1} << (3 * level);
    if (parts.top.count() != cells + 1) {
        return parts.top.damage(DamageKind::bad_count, 0, parts.top.count(), cells + 1);
    }
    for (std::uint64_t cell = 0; cell <= cells; ++cell) {
        const std::uint64_t before = parts.top[cell];
        if (before > parts.leaf_count) {
            return parts.top.damage(DamageKind::bad_index, cell, before, parts.leaf_count);
        }
        const std::uint64_t code = cell * cells_below(level);
        if ((before > 0 && parts.leaf_codes[before - 1] >= code) ||
            (before < parts.leaf_count && parts.leaf_codes[before] < code)) {
            return parts.top.damage(DamageKind::bad_order, cell, before, parts.leaf_count);
        }
    }
    return std::nullopt;
}

/// Finds damage in a chained table. Chains must rise, so that they end, and contain only nodes of
/// their own slot. There must be as many links as nodes.
Found find_bad_table(const Parts& parts, const SectionView<std::uint32_t>& table,
                     std::uint64_t (*slot_of)(std::uint64_t, std::uint32_t) noexcept) noexcept {
    const std::uint32_t bits = parts.grid[0].slot_bits;
    assert(bits < 64);
    const std::uint64_t slots = std::uint64_t{1} << bits;
    const std::uint64_t nodes = parts.nodes.count();
    if (table.count() != slots + nodes) {
        return table.damage(DamageKind::bad_count, 0, table.count(), slots + nodes);
    }
    std::uint64_t links = 0;
    for (std::uint64_t i = 0; i < slots + nodes; ++i) {
        const std::uint64_t link = table[i];
        if (link == 0) continue;
        ++links;
        const std::uint64_t behind = i < slots ? 0 : i - slots + 1;
        if (link > nodes) return table.damage(DamageKind::bad_index, i, link, nodes);
        if (link <= behind) return table.damage(DamageKind::bad_order, i, link, behind + 1);
        const std::uint64_t slot = i < slots ? i : slot_of(parts.nodes[i - slots].key, bits);
        if (slot_of(parts.nodes[link - 1].key, bits) != slot) {
            return table.damage(DamageKind::bad_order, i, link, slot);
        }
    }
    if (links == nodes) return std::nullopt;
    return table.damage(DamageKind::bad_count, 0, links, nodes);
}

Found find_bad_tables(Bytes file, SectionSet wanted, const Parts& parts) noexcept {
    const bool sorted = wanted.contains(SectionId::octree_leaf_codes) &&
                        wanted.contains(SectionId::octree_leaf_nodes);
    if (sorted) {
        if (const Found damage = find_bad_sorted_leaf(parts)) return damage;
        if (wanted.contains(SectionId::octree_top)) {
            if (const Found damage = find_bad_top(parts)) return damage;
        }
    }
    const auto bad_table = [&](SectionId id, auto slot_of) -> Found {
        if (!wanted.contains(id)) return std::nullopt;
        return find_bad_table(parts, SectionView<std::uint32_t>(file, id, wanted), slot_of);
    };
    if (const Found damage = bad_table(SectionId::octree_modulus_table, &modulus_slot)) {
        return damage;
    }
    return bad_table(SectionId::octree_mixed_table, &mixed_slot);
}

}  // namespace

std::optional<Damage> find_missing_octree(std::span<const std::byte> file) noexcept {
    if (const Found damage = find_gap(file, kTableIds)) return damage;
    const bool has_more =
        find_section(file, kTableIds[0]) || find_section(file, SectionId::octree_boxes);
    if (!has_more) return find_gap(file, kTreeIds);
    for (const SectionId id : kTreeIds) {
        if (!find_section(file, id)) return missing_section(id);
    }
    return std::nullopt;
}

std::optional<Damage> find_octree_damage(std::span<const std::byte> file,
                                         SectionSet wanted) noexcept {
    for (const SectionId id : kTreeIds) {
        if (!wanted.contains(id) || !find_section(file, id)) return std::nullopt;
    }
    Parts parts(file, wanted);
    if (const Found damage = find_bad_grid(parts)) return damage;
    if (const Found damage = find_bad_tree(parts)) return damage;
    if (const Found damage =
            find_bad_cell_box(file, SectionId::octree_boxes, wanted, parts.nodes.count())) {
        return damage;
    }
    if (!find_section(file, kTableIds[0])) return std::nullopt;
    return find_bad_tables(file, wanted, parts);
}

}  // namespace cdprep::format
