// SPDX-License-Identifier: MIT
#include "find_tetra_damage.h"

#include <array>
#include <bit>
#include <cmath>

#include "cdprep/format/content_hash.h"
#include "cdprep/format/limits.h"
#include "cdprep/format/tetra_tree.h"
#include "reference_lists.h"

// Nodes stand level by level, the octants first, so the children of each follow those of
// the one before, and so do lists: one pass with two counters proves that every node and
// every reference is reached once. Keys that continue their parents' end by themselves.

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;
using Bytes = std::span<const std::byte>;

/// A tetra-tree's sections, as far as they are wanted.
struct Parts {
    SectionView<TetraTree> tree;
    SectionView<TetraNode> nodes;
    SectionView<std::uint32_t> references;
    SectionView<std::uint32_t> top;
    std::uint64_t triangle_count;

    Parts(Bytes file, SectionSet wanted) noexcept
        : tree(file, SectionId::tetra_tree, wanted),
          nodes(file, SectionId::tetra_nodes, wanted),
          references(file, SectionId::tetra_references, wanted),
          top(file, SectionId::tetra_top, wanted),
          triangle_count(read_header(file).triangle_count) {}
};

bool is_leaf(const TetraNode& node) noexcept {
    return (node.flags & tetra_inner) == 0;
}

Found find_bad_facts(const Parts& parts) noexcept {
    if (parts.tree.count() != 1) {
        return parts.tree.damage(DamageKind::bad_count, 0, parts.tree.count(), 1);
    }
    const TetraTree tree = parts.tree[0];
    for (const double x : {tree.centre.x, tree.centre.y, tree.centre.z}) {
        if (!(std::fabs(x) <= kMaxCoordinate)) {
            return parts.tree.damage(DamageKind::bad_number, 0, 0, 0);
        }
    }
    const auto limited = [&](std::uint64_t found, std::uint64_t limit) -> Found {
        if (found <= limit) return std::nullopt;
        return parts.tree.damage(DamageKind::bad_index, 0, found, limit);
    };
    constexpr std::uint32_t kFlags = tetra_centre_inside | tetra_centre_on;
    if (const Found damage = limited(tree.level, kMaxTetraLevel)) return damage;
    if (const Found damage = limited(tree.top_level, tree.level)) return damage;
    if (const Found damage = limited(static_cast<std::uint32_t>(tree.bounding),
                                     static_cast<std::uint32_t>(TetraBounding::caps))) {
        return damage;
    }
    if (const Found damage = limited(tree.flags, kFlags)) return damage;
    return limited(tree.centre_count, parts.references.count());
}

/// Where the next node's children and references begin.
struct Next {
    std::uint64_t child;
    std::uint64_t reference;
};

bool has_radii(const TetraNode& node) noexcept {
    return node.radius_min >= 0 && node.radius_min <= node.radius_max;  // false for NaN
}

Found find_bad_inner(const Parts& parts, std::uint64_t i, const TetraNode& node,
                     Next& next) noexcept {
    const auto bad = [&](std::uint64_t found, std::uint64_t limit) {
        return parts.nodes.damage(DamageKind::bad_order, i, found, limit);
    };
    const std::uint32_t children = node.flags & tetra_children;
    const auto count = static_cast<std::uint32_t>(std::popcount(children));
    if (tetra_level(node.key) >= parts.tree[0].level) {
        return bad(tetra_level(node.key), parts.tree[0].level);
    }
    if (node.flags != (tetra_inner | children) || count == 0) return bad(node.flags, 0);
    if (node.count != count) return bad(node.count, count);
    if (node.first != next.child) return bad(node.first, next.child);
    for (std::uint32_t child = 0; child < 4; ++child) {
        if ((children >> child & 1) == 0) continue;
        if (next.child >= parts.nodes.count()) return bad(next.child, parts.nodes.count() - 1);
        const std::uint32_t key = parts.nodes[next.child].key;
        if (key != (node.key << 2 | child)) {
            return parts.nodes.damage(DamageKind::bad_order, next.child, key,
                                      node.key << 2 | child);
        }
        ++next.child;
    }
    return std::nullopt;
}

Found find_bad_leaf(const Parts& parts, std::uint64_t i, const TetraNode& node,
                    Next& next) noexcept {
    const auto bad = [&](std::uint64_t found, std::uint64_t limit) {
        return parts.nodes.damage(DamageKind::bad_order, i, found, limit);
    };
    const std::uint64_t room = parts.references.count() - next.reference;
    if (node.flags != 0) return bad(node.flags, 0);
    if (node.first != next.reference) return bad(node.first, next.reference);
    if (node.count == 0 || node.count > room) return bad(node.count, room);
    next.reference += node.count;
    return find_bad_list(parts.references, node.first, node.count, parts.triangle_count);
}

/// The number of octants that come first, their keys rising; the rest are somebody's
/// children or damage.
std::uint64_t count_octants(const Parts& parts) noexcept {
    std::uint64_t count = 0;
    std::uint32_t least = 8;
    while (count < parts.nodes.count()) {
        const std::uint32_t key = parts.nodes[count].key;
        if (key < least || key >= 16) break;
        least = key + 1;
        ++count;
    }
    return count;
}

Found find_bad_tree(const Parts& parts) noexcept {
    const std::uint64_t centre = parts.tree[0].centre_count;
    if (const Found damage = find_bad_list(parts.references, 0, centre, parts.triangle_count)) {
        return damage;
    }
    Next next{count_octants(parts), centre};
    for (std::uint64_t i = 0; i < parts.nodes.count(); ++i) {
        // Nobody's child: its key was not compared with a parent's.
        if (i >= next.child) return parts.nodes.damage(DamageKind::bad_order, i, i, next.child);
        const TetraNode node = parts.nodes[i];
        if (!has_radii(node)) return parts.nodes.damage(DamageKind::bad_number, i, 0, 0);
        const Found damage = is_leaf(node) ? find_bad_leaf(parts, i, node, next)
                                           : find_bad_inner(parts, i, node, next);
        if (damage) return damage;
    }
    if (next.reference == parts.references.count()) return std::nullopt;
    return parts.references.damage(DamageKind::bad_count, 0, parts.references.count(),
                                   next.reference);
}

/// The cones of top_level below a node of that level, or a leaf above it, name it; those
/// that no such node holds are 0.
Found find_bad_top(const Parts& parts) noexcept {
    const std::uint32_t level = parts.tree[0].top_level;
    const std::uint32_t cones = tetra_cones(level);
    if (parts.top.count() != cones) {
        return parts.top.damage(DamageKind::bad_count, 0, parts.top.count(), cones);
    }
    std::uint64_t named = 0;
    for (std::uint64_t i = 0; i < parts.nodes.count(); ++i) {
        const TetraNode node = parts.nodes[i];
        const std::uint32_t at = tetra_level(node.key);
        if (at > level) break;
        if (at < level && !is_leaf(node)) continue;
        const std::uint64_t below = std::uint64_t{1} << (2 * (level - at));
        const std::uint64_t first = node.key * below - cones;
        for (std::uint64_t cone = first; cone < first + below; ++cone, ++named) {
            if (parts.top[cone] == i + 1) continue;
            return parts.top.damage(DamageKind::bad_order, cone, parts.top[cone], i + 1);
        }
    }
    for (std::uint64_t cone = 0; cone < cones; ++cone) named -= parts.top[cone] != 0 ? 1 : 0;
    if (named == 0) return std::nullopt;
    return parts.top.damage(DamageKind::bad_count, 0, 0 - named, 0);
}

constexpr std::array<SectionId, 4> kIds = {SectionId::tetra_tree, SectionId::tetra_nodes,
                                           SectionId::tetra_references, SectionId::tetra_top};

}  // namespace

std::optional<Damage> find_missing_tetra(std::span<const std::byte> file) noexcept {
    if (const Found gap = find_gap(file, kIds)) return gap;
    const bool has_tree = find_section(file, SectionId::tetra_tree).has_value();
    if (!has_tree || find_section(file, SectionId::triangles)) return std::nullopt;
    return Damage{DamageKind::missing_section, SectionId::triangles, kSectionTableOffset, 0, 1};
}

std::optional<Damage> find_tetra_damage(std::span<const std::byte> file,
                                        SectionSet wanted) noexcept {
    if (!find_section(file, SectionId::tetra_tree) ||
        !wanted.contains({SectionId::tetra_tree, SectionId::tetra_nodes,
                          SectionId::tetra_references, SectionId::tetra_top})) {
        return std::nullopt;
    }
    const Parts parts(file, wanted);
    if (const Found damage = find_bad_facts(parts)) return damage;
    if (const Found damage = find_bad_tree(parts)) return damage;
    return find_bad_top(parts);
}

}  // namespace cdprep::format
