// SPDX-License-Identifier: MIT
#include "section_checks.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "cdprep/format/content_hash.h"
#include "cdprep/format/limits.h"
#include "cell_boxes.h"
#include "reference_lists.h"

// Nodes are stored level by level, siblings side by side, and leaves' lists in the order of the
// nodes. So one pass with a counter for each proves that every node and every reference is reached
// once. Then the tree can be walked, and each split compared with its box.

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;
using Bytes = std::span<const std::byte>;
using Point = std::array<double, 3>;

constexpr std::array kIds = {SectionId::adaptive_octree, SectionId::adaptive_octree_nodes,
                             SectionId::adaptive_octree_references};

/// The wanted sections of an adaptive octree.
struct Parts {
    SectionView<AdaptiveOctree> tree;
    SectionView<AdaptiveOctreeNode> nodes;
    SectionView<std::uint32_t> references;
    std::uint64_t triangle_count;

    Parts(Bytes file, SectionSet wanted) noexcept
        : tree(file, SectionId::adaptive_octree, wanted),
          nodes(file, SectionId::adaptive_octree_nodes, wanted),
          references(file, SectionId::adaptive_octree_references, wanted),
          triangle_count(read_header(file).triangle_count) {}
};

bool is_coordinate(double x) noexcept {
    return std::fabs(x) <= kMaxCoordinate;  // false for NaN
}

/// Returns the children of a node as a set, which is empty for a leaf.
std::uint32_t children_of(const AdaptiveOctreeNode& node) noexcept {
    return (node.count & kInnerNode) != 0 ? node.count & 0xff : 0;
}

Found find_bad_facts(const Parts& parts) noexcept {
    const auto bad = [&](DamageKind kind, std::uint64_t found, std::uint64_t limit) {
        return parts.tree.damage(kind, 0, found, limit);
    };
    if (parts.tree.count() != 1) return bad(DamageKind::bad_count, parts.tree.count(), 1);
    const AdaptiveOctree tree = parts.tree[0];
    if (tree.level > kOctreeBits) return bad(DamageKind::bad_index, tree.level, kOctreeBits);
    const auto rule = static_cast<std::uint32_t>(tree.rule);
    const auto last_rule = static_cast<std::uint32_t>(SplitRule::surface_area);
    if (rule > last_rule) return bad(DamageKind::bad_index, rule, last_rule);
    for (const double x :
         {tree.lower.x, tree.lower.y, tree.lower.z, tree.upper.x, tree.upper.y, tree.upper.z}) {
        if (!is_coordinate(x)) return bad(DamageKind::bad_number, 0, 0);
    }
    const bool is_box = tree.lower.x <= tree.upper.x && tree.lower.y <= tree.upper.y &&
                        tree.lower.z <= tree.upper.z;
    if (!is_box) return bad(DamageKind::bad_box, 0, 0);
    return std::nullopt;
}

/// The places where the next node's children and references begin, and its level.
struct Next {
    std::uint64_t child = 1;
    std::uint64_t reference = 0;
    std::uint64_t level_end = 1;
    std::uint32_t level = 0;
};

Found find_bad_inner(const Parts& parts, std::uint64_t i, const AdaptiveOctreeNode& node,
                     Next& next) noexcept {
    const auto bad = [&](std::uint64_t found, std::uint64_t limit) {
        return parts.nodes.damage(DamageKind::bad_order, i, found, limit);
    };
    const std::uint32_t children = children_of(node);
    const std::uint32_t most_level = parts.tree[0].level;
    if (next.level >= most_level) return bad(next.level, most_level);
    if (node.count != (kInnerNode | children) || children == 0) return bad(node.count, 0);
    if (node.first != next.child) return bad(node.first, next.child);
    next.child += static_cast<std::uint64_t>(std::popcount(children));
    if (next.child <= parts.nodes.count()) return std::nullopt;
    return bad(next.child, parts.nodes.count());
}

Found find_bad_leaf(const Parts& parts, std::uint64_t i, const AdaptiveOctreeNode& node,
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

Found find_bad_tree(const Parts& parts) noexcept {
    const std::uint64_t count = parts.nodes.count();
    if ((count == 0) != (parts.triangle_count == 0)) {
        return parts.nodes.damage(DamageKind::bad_count, 0, count, parts.triangle_count);
    }
    Next next;
    for (std::uint64_t i = 0; i < count; ++i) {
        // Node i is not the child of any node.
        if (i >= next.child) return parts.nodes.damage(DamageKind::bad_order, i, i, next.child - 1);
        if (i == next.level_end) {
            next.level_end = next.child;
            ++next.level;
        }
        const AdaptiveOctreeNode node = parts.nodes[i];
        const Found damage = (node.count & kInnerNode) == 0 ? find_bad_leaf(parts, i, node, next)
                                                            : find_bad_inner(parts, i, node, next);
        if (damage) return damage;
    }
    if (next.reference == parts.references.count()) return std::nullopt;
    return parts.references.damage(DamageKind::bad_count, 0, parts.references.count(),
                                   next.reference);
}

Point point(const Double3& p) noexcept {
    return {p.x, p.y, p.z};
}

struct Box {
    Point lower;
    Point upper;
};

/// The children above the split plane of each axis, as a set.
constexpr std::array<std::uint32_t, 3> kUpperChildren = {0xaa, 0xcc, 0xf0};

/// Returns whether a split is good. Along each axis it must be inside the box, or at its upper
/// bound with no child above. It must be inside along at least one axis.
bool is_good_split(const Box& box, const Point& split, std::uint32_t children) noexcept {
    bool divides = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double s = split[axis];
        if (box.lower[axis] < s && s < box.upper[axis]) {
            divides = true;
        } else if (s != box.upper[axis] || (children & kUpperChildren[axis]) != 0) {
            return false;
        }
    }
    return divides;
}

Box child_box(const Box& box, const Point& split, std::uint32_t child) noexcept {
    Box part = box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ((child >> axis & 1) != 0 ? part.lower : part.upper)[axis] = split[axis];
    }
    return part;
}

/// A node on the way from the root, and those of its children that are not visited yet.
struct Step {
    Box box;
    Point split;
    std::uint32_t next;  ///< its next child
    std::uint32_t rest;
};

/// Walks the tree from the root down. It is proven to be a tree and no deeper than kOctreeBits. A
/// node's box follows from the splits above it.
class SplitCheck {
public:
    explicit SplitCheck(const Parts& parts) noexcept : parts_(parts) {}

    Found find_bad_split() noexcept {
        const AdaptiveOctree tree = parts_.tree[0];
        Found found = enter(0, {point(tree.lower), point(tree.upper)});
        while (!found && depth_ > 0) {
            Step& step = path_[depth_ - 1];
            if (step.rest == 0) {
                --depth_;
                continue;
            }
            const auto child = static_cast<std::uint32_t>(std::countr_zero(step.rest));
            step.rest &= step.rest - 1;
            found = enter(step.next++, child_box(step.box, step.split, child));
        }
        return found;
    }

private:
    Found enter(std::uint32_t index, const Box& box) noexcept {
        const AdaptiveOctreeNode node = parts_.nodes[index];
        const std::uint32_t children = children_of(node);
        const Point split = point(node.split);
        const bool is_good =
            children == 0 ? split == Point{0, 0, 0} : is_good_split(box, split, children);
        if (!is_good) return parts_.nodes.damage(DamageKind::bad_box, index, index, 0);
        assert(children == 0 || depth_ < path_.size());
        if (children != 0) path_[depth_++] = {box, split, node.first, children};
        return std::nullopt;
    }

    const Parts& parts_;
    std::array<Step, kOctreeBits> path_{};
    std::size_t depth_ = 0;
};

}  // namespace

std::optional<Damage> find_missing_adaptive_octree(std::span<const std::byte> file) noexcept {
    if (const Found gap = find_gap(file, kIds)) return gap;
    const bool has_tree = find_section(file, kIds[0]).has_value();
    if (!has_tree && find_section(file, SectionId::adaptive_octree_boxes)) {
        return missing_section(kIds[0]);
    }
    if (!has_tree || find_section(file, SectionId::triangles)) return std::nullopt;
    return missing_section(SectionId::triangles);
}

std::optional<Damage> find_adaptive_octree_damage(std::span<const std::byte> file,
                                                  SectionSet wanted) noexcept {
    for (const SectionId id : kIds) {
        if (!wanted.contains(id) || !find_section(file, id)) return std::nullopt;
    }
    const Parts parts(file, wanted);
    if (const Found damage = find_bad_facts(parts)) return damage;
    if (const Found damage = find_bad_tree(parts)) return damage;
    if (parts.nodes.count() != 0) {
        if (const Found damage = SplitCheck(parts).find_bad_split()) return damage;
    }
    return find_bad_cell_box(file, SectionId::adaptive_octree_boxes, wanted, parts.nodes.count());
}

}  // namespace cdprep::format
