// SPDX-License-Identifier: MIT
#include "cdprep/cells/find_list_damage.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "cdprep/format/float_environment.h"
#include "cells/cell_bounds.h"
#include "cells/find_cone_damage.h"
#include "cells/list_places.h"
#include "cells/octree_codes.h"
#include "cells/split_box.h"
#include "exact/triangle_box.h"

// Every triangle goes down the tree by itself, into each child whose closed cell it touches, stored
// or not. It must find every such child, and itself in each leaf. If the places where triangles
// were found are all the references, none is superfluous.

namespace cdprep {
namespace {

using format::kInnerNode;
using format::OctreeNode;

using Found = std::optional<format::Damage>;

/// A model's octree in the form for the check.
class OctreeCells {
public:
    using Node = OctreeNode;
    static constexpr SectionId kTree = SectionId::octree_grid;
    static constexpr SectionId kNodes = SectionId::octree_nodes;
    static constexpr SectionId kReferences = SectionId::octree_references;
    static constexpr SectionId kBoxes = SectionId::octree_boxes;

    explicit OctreeCells(const Model& model) : grid_(*model.octree().grid), model_(model) {}

    [[nodiscard]] std::span<const Node> nodes() const {
        return model_.octree().nodes;
    }
    [[nodiscard]] std::span<const std::uint32_t> references() const {
        return model_.octree().references;
    }
    [[nodiscard]] std::span<const format::CellBox> boxes() const {
        return model_.octree().boxes;
    }
    [[nodiscard]] Box3 root() const {
        return octree_box(grid_, {0, 0, 0}, 0);
    }
    /// Returns whether a point is more than a step inside the cube.
    [[nodiscard]] bool is_inside(const Double3& p) const {
        const std::uint32_t last = kOctreeSteps - 1;
        const auto inside = [&](double origin, double x) {
            return octree_plane(origin, grid_.step, 1) < x &&
                   x < octree_plane(origin, grid_.step, last);
        };
        return inside(grid_.origin.x, p.x) && inside(grid_.origin.y, p.y) &&
               inside(grid_.origin.z, p.z);
    }
    [[nodiscard]] std::optional<Box3> child(const Node& node, const Box3& /*box*/,
                                            std::uint32_t child) const {
        const CellPlace first = octree_place(node.key << 3 | child);
        return octree_box(grid_, first, level_of(node.key) + 1);
    }

private:
    const format::OctreeGrid& grid_;
    const Model& model_;
};

/// The same for an octree with split points of its own.
class AdaptiveOctreeCells {
public:
    using Node = format::AdaptiveOctreeNode;
    static constexpr SectionId kTree = SectionId::adaptive_octree;
    static constexpr SectionId kNodes = SectionId::adaptive_octree_nodes;
    static constexpr SectionId kReferences = SectionId::adaptive_octree_references;
    static constexpr SectionId kBoxes = SectionId::adaptive_octree_boxes;

    explicit AdaptiveOctreeCells(const Model& model) : model_(model) {}

    [[nodiscard]] std::span<const Node> nodes() const {
        return model_.adaptive_octree().nodes;
    }
    [[nodiscard]] std::span<const std::uint32_t> references() const {
        return model_.adaptive_octree().references;
    }
    [[nodiscard]] std::span<const format::CellBox> boxes() const {
        return model_.adaptive_octree().boxes;
    }
    [[nodiscard]] Box3 root() const {
        return {model_.adaptive_octree().tree->lower, model_.adaptive_octree().tree->upper};
    }
    [[nodiscard]] bool is_inside(const Double3& p) const {
        return overlap(root(), {p, p});
    }
    /// Returns nothing for a child above an axis that is not divided.
    [[nodiscard]] std::optional<Box3> child(const Node& node, const Box3& box,
                                            std::uint32_t child) const {
        const Double3& s = node.split;
        const Double3& upper = box.upper;
        const bool x = (child & 1) != 0, y = (child & 2) != 0, z = (child & 4) != 0;
        if ((x && s.x == upper.x) || (y && s.y == upper.y) || (z && s.z == upper.z)) {
            return std::nullopt;
        }
        return split_box(box, s, child);
    }

private:
    const Model& model_;
};

template <class Cells>
class ListCheck {
public:
    ListCheck(std::span<const std::byte> file, const Model& model)
        : file_(file), model_(model), cells_(model), moved_(model, nullptr), frame_(model) {}

    Found find_damage() {
        if (const Found damage = find_outside()) return damage;
        if (const Found damage = find_small_parent()) return damage;
        std::uint64_t places = 0;
        for (std::uint32_t i = 0; i < model_.triangle_count(); ++i) {
            places_.clear();
            if (const Found damage = send_down(moved_.corners(i), i, 0, cells_.root())) {
                return damage;
            }
            if (const Found damage =
                    find_wrong_mark(file_, Cells::kReferences, cells_.references(), places_)) {
                return damage;
            }
            places += places_.size();
        }
        if (places == cells_.references().size()) return std::nullopt;
        return format::wrong_fact(file_, Cells::kReferences, 0, cells_.references().size(), places);
    }

private:
    using Node = typename Cells::Node;

    std::span<const std::byte> file_;
    const Model& model_;
    Cells cells_;
    MovedModel moved_;
    FrameOf frame_;
    std::vector<std::uint32_t> places_;  ///< references to the current triangle

    [[nodiscard]] Found find_outside() const {
        for (std::uint32_t i = 0; i < model_.triangle_count(); ++i) {
            for (const Double3& p : moved_.corners(i)) {
                if (!cells_.is_inside(p)) return format::wrong_fact(file_, Cells::kTree, 0, i, 0);
            }
        }
        return std::nullopt;
    }

    /// Sends a triangle down from a node whose cell it touches.
    Found send_down(const Corners& t, std::uint32_t triangle, std::uint32_t number,
                    const Box3& box) {
        const Node& node = cells_.nodes()[number];
        if ((node.count & kInnerNode) == 0) return look_up(t, triangle, number, box);
        for (std::uint32_t child = 0; child < 8; ++child) {
            const std::optional<Box3> below = cells_.child(node, box, child);
            if (!below || !triangle_touches_box(t, *below)) continue;
            const std::uint32_t children = node.count & 0xff;
            if ((children >> child & 1) == 0) {
                return format::wrong_fact(file_, Cells::kNodes, number, children,
                                          children | 1U << child);
            }
            const int before = std::popcount(children & ((1U << child) - 1));
            const std::uint32_t next = node.first + static_cast<std::uint32_t>(before);
            if (const Found damage = send_down(t, triangle, next, *below)) return damage;
        }
        return std::nullopt;
    }

    /// Looks a triangle up in a leaf that it touches.
    Found look_up(const Corners& t, std::uint32_t triangle, std::uint32_t number,
                  const Box3& cell) {
        const Node& leaf = cells_.nodes()[number];
        const auto place = find_reference(cells_.references(), leaf.first, leaf.count, triangle);
        if (!place) return format::wrong_fact(file_, Cells::kNodes, number, leaf.count, triangle);
        places_.push_back(*place);
        return cells_.boxes().empty() ? std::nullopt : find_small_box(t, number, cell);
    }

    /// Finds a leaf's box that certainly excludes part of what a triangle's box has in the cell.
    [[nodiscard]] Found find_small_box(const Corners& t, std::uint32_t number,
                                       const Box3& cell) const {
        const Box3 around = box_around(t);
        const format::CellBox& box = cells_.boxes()[number];
        const auto is_outside = [&](std::size_t axis, double lower, double upper) {
            return frame_.frame(axis, upper) > above(box.upper[axis]) ||
                   frame_.frame(axis, lower) < below(box.lower[axis]);
        };
        const auto& [a, b] = around;
        const bool is_small =
            is_outside(0, std::max(a.x, cell.lower.x), std::min(b.x, cell.upper.x)) ||
            is_outside(1, std::max(a.y, cell.lower.y), std::min(b.y, cell.upper.y)) ||
            is_outside(2, std::max(a.z, cell.lower.z), std::min(b.z, cell.upper.z));
        if (!is_small) return std::nullopt;
        return format::wrong_fact(file_, Cells::kBoxes, number, number, 0);
    }
    /// Widens a coordinate by the rounding of coordinates in the frame.
    static double above(double x) {
        return x + std::fabs(x) * 0x1p-50 + 0x1p-1000;
    }
    static double below(double x) {
        return x - std::fabs(x) * 0x1p-50 - 0x1p-1000;
    }

    /// Finds an inner node's box that does not contain a child's.
    [[nodiscard]] Found find_small_parent() const {
        const auto boxes = cells_.boxes();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Node& node = cells_.nodes()[i];
            if ((node.count & kInnerNode) == 0) continue;
            const auto children = static_cast<std::size_t>(std::popcount(node.count & 0xff));
            for (const format::CellBox& child : boxes.subspan(node.first, children)) {
                if (!holds(boxes[i], child))
                    return format::wrong_fact(file_, Cells::kBoxes, i, i, 0);
            }
        }
        return std::nullopt;
    }
    static bool holds(const format::CellBox& outer, const format::CellBox& inner) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (inner.lower[axis] < outer.lower[axis]) return false;
            if (inner.upper[axis] > outer.upper[axis]) return false;
        }
        return true;
    }
};

/// Finds a node that is missing from its slot's chain.
Found find_lost_node(std::span<const std::byte> file, const Model& model, SectionId id,
                     std::span<const std::uint32_t> table,
                     std::uint64_t (*slot_of)(std::uint64_t, std::uint32_t) noexcept) {
    const std::uint32_t bits = model.octree().grid->slot_bits;
    const auto next = table.subspan(std::size_t{1} << bits);
    const auto nodes = model.octree().nodes;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const std::uint64_t slot = slot_of(nodes[i].key, bits);
        std::uint32_t at = table[slot];
        while (at != 0 && at != i + 1) at = next[at - 1];
        if (at == 0) return format::wrong_fact(file, id, slot, table[slot], i + 1);
    }
    return std::nullopt;
}

}  // namespace

std::optional<format::Damage> find_list_damage(std::span<const std::byte> file,
                                               const Model& model) {
    const format::FloatEnvironment environment;
    if (const Found damage = find_cone_damage(file, model)) return damage;
    if (model.adaptive_octree().tree != nullptr) {
        if (const Found damage = ListCheck<AdaptiveOctreeCells>(file, model).find_damage()) {
            return damage;
        }
    }
    if (model.octree().grid == nullptr) return std::nullopt;
    if (const Found damage = ListCheck<OctreeCells>(file, model).find_damage()) return damage;
    if (model.octree().modulus_table.empty()) return std::nullopt;
    if (const Found damage = find_lost_node(file, model, SectionId::octree_modulus_table,
                                            model.octree().modulus_table, &format::modulus_slot)) {
        return damage;
    }
    return find_lost_node(file, model, SectionId::octree_mixed_table, model.octree().mixed_table,
                          &format::mixed_slot);
}

}  // namespace cdprep
