// SPDX-License-Identifier: MIT
#include "section_checks.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "cdprep/format/content_hash.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/limits.h"
#include "cdprep/format/tetra_tree.h"
#include "reference_lists.h"

// Nodes are stored level by level, the octants first. So the children and lists of each follow
// those of the one before. One pass with two counters proves that every node and every reference is
// reached once. Keys that continue their parents' keys end by themselves.

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;
using Bytes = std::span<const std::byte>;

/// The common form of BvhNode and OrientedNode: rows of numbers of eight boxes side by side.
template <std::size_t kRows>
using Rows = std::array<std::array<float, kBvhWidth>, kRows>;
static_assert(sizeof(Rows<6>) == sizeof(BvhNode) && sizeof(Rows<12>) == sizeof(OrientedNode));

/// The wanted sections of a tetra-tree.
struct Parts {
    SectionView<TetraTree> tree;
    SectionView<TetraNode> nodes;
    SectionView<std::uint32_t> references;
    SectionView<std::uint32_t> top;
    SectionView<Rows<6>> boxes;
    SectionView<Rows<12>> oriented;
    std::uint64_t triangle_count;

    Parts(Bytes file, SectionSet wanted) noexcept
        : tree(file, SectionId::tetra_tree, wanted),
          nodes(file, SectionId::tetra_nodes, wanted),
          references(file, SectionId::tetra_references, wanted),
          top(file, SectionId::tetra_top, wanted),
          boxes(file, SectionId::tetra_boxes, wanted),
          oriented(file, SectionId::tetra_oriented, wanted),
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
                                     static_cast<std::uint32_t>(TetraBounding::boxes))) {
        return damage;
    }
    if (const Found damage = limited(tree.flags, kFlags)) return damage;
    return limited(tree.centre_count, parts.references.count());
}

/// The places where the next node's children and references begin.
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
    assert(next.reference <= parts.references.count());
    const std::uint64_t room = parts.references.count() - next.reference;
    if (node.flags != 0) return bad(node.flags, 0);
    if (node.first != next.reference) return bad(node.first, next.reference);
    if (node.count == 0 || node.count > room) return bad(node.count, room);
    next.reference += node.count;
    return find_bad_list(parts.references, node.first, node.count, parts.triangle_count);
}

/// Returns the number of octants at the beginning, with rising keys. The other nodes are children
/// or damage.
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
        // Node i is not the child of any node: its key was not compared with a parent's.
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

/// Finds damage in the top table. A node of top_level, or a leaf above it, must be named by the
/// cones of top_level below it. Cones without such a node are 0.
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

/// Returns whether the box of a node lies in the frame, with ordered bounds. Rows are those of
/// BvhNode.
bool is_box(const Rows<6>& rows, std::uint32_t lane) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float lower = rows[axis][lane];
        const float upper = rows[3 + axis][lane];
        if (!(lower >= -1 && lower <= upper && upper <= 1)) return false;
    }
    return true;
}

/// Returns whether an oriented box of a node has valid numbers. Rows are those of OrientedNode.
bool is_box(const Rows<12>& rows, std::uint32_t lane) noexcept {
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const float x = rows[row][lane];
        const bool is_half = row >= 9;
        if (!std::isfinite(x) || (is_half && x < 0)) return false;
    }
    return true;
}

/// Returns whether a column of `a` equals one of `b`.
template <std::size_t kRows>
bool same_lane(const Rows<kRows>& a, std::uint32_t lane_a, const Rows<kRows>& b,
               std::uint32_t lane_b) noexcept {
    for (std::size_t row = 0; row < kRows; ++row) {
        if (a[row][lane_a] != b[row][lane_b]) return false;
    }
    return true;
}

/// Finds a box that is invalid, or that differs between the two elements that store it. `unused` is
/// the box of no node.
template <std::size_t kRows>
Found find_bad_boxes(const SectionView<Rows<kRows>>& section, std::uint64_t nodes,
                     const std::array<float, kRows>& unused) noexcept {
    const std::uint64_t expected = tetra_box_count(nodes);
    if (section.count() != expected) {
        return section.damage(DamageKind::bad_count, 0, section.count(), expected);
    }
    Rows<kRows> none;
    for (std::size_t row = 0; row < kRows; ++row) none[row].fill(unused[row]);
    Rows<kRows> before;
    for (std::uint64_t i = 0; i < expected; ++i) {
        const Rows<kRows> rows = section[i];
        for (std::uint32_t lane = 0; lane < kBvhWidth; ++lane) {
            const bool is_used = kTetraBoxStride * i + lane < nodes;
            const bool is_good = is_used ? is_box(rows, lane) : same_lane(rows, lane, none, 0);
            if (!is_good) return section.damage(DamageKind::bad_number, i, lane, kBvhWidth - 1);
            if (i == 0 || lane >= kTetraBoxStride) continue;
            if (!same_lane(rows, lane, before, lane + kTetraBoxStride)) {
                return section.damage(DamageKind::bad_order, i, lane, 0);
            }
        }
        before = rows;
    }
    return std::nullopt;
}

Found find_bad_boxes(const Parts& parts, SectionSet wanted) noexcept {
    if (parts.tree[0].bounding != TetraBounding::boxes) return std::nullopt;
    const std::uint64_t nodes = parts.nodes.count();
    if (wanted.contains(SectionId::tetra_boxes)) {
        const Found damage = find_bad_boxes<6>(parts.boxes, nodes, {1, 1, 1, -1, -1, -1});
        if (damage) return damage;
    }
    if (!wanted.contains(SectionId::tetra_oriented)) return std::nullopt;
    return find_bad_boxes<12>(parts.oriented, nodes, {1, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, -1});
}

/// Finds boxes that contradict the tree's facts: missing, or present without reason.
Found find_missing_boxes(Bytes file, TetraBounding bounding) noexcept {
    const bool wants_boxes = bounding == TetraBounding::boxes;
    for (const SectionId id : {SectionId::tetra_boxes, SectionId::tetra_oriented}) {
        const bool is_there = find_section(file, id).has_value();
        if (wants_boxes && !is_there) return missing_section(id);
        if (!wants_boxes && is_there) {
            return Damage{DamageKind::bad_section, id, kSectionTableOffset, 1, 0};
        }
    }
    return std::nullopt;
}

constexpr std::array<SectionId, 4> kIds = {SectionId::tetra_tree, SectionId::tetra_nodes,
                                           SectionId::tetra_references, SectionId::tetra_top};

}  // namespace

std::optional<Damage> find_missing_tetra(std::span<const std::byte> file) noexcept {
    if (const Found gap = find_gap(file, kIds)) return gap;
    const bool has_tree = find_section(file, SectionId::tetra_tree).has_value();
    const bool has_boxes = find_section(file, SectionId::tetra_boxes).has_value() ||
                           find_section(file, SectionId::tetra_oriented).has_value();
    if (!has_tree && has_boxes) return missing_section(SectionId::tetra_tree);
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
    if (const Found damage = find_missing_boxes(file, parts.tree[0].bounding)) return damage;
    if (const Found damage = find_bad_tree(parts)) return damage;
    if (const Found damage = find_bad_top(parts)) return damage;
    return find_bad_boxes(parts, wanted);
}

}  // namespace cdprep::format
