// SPDX-License-Identifier: MIT
#include "cdprep/find_list_damage.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "cdprep/format/sections.h"
#include "octree_codes.h"
#include "triangle_box.h"

// Every triangle goes down the tree by itself, into each child whose closed cell it touches,
// stored or not. It must find every such child, and itself in each leaf; when the places
// where it was found are all the references there are, none is too many.

namespace cdprep {
namespace {

using format::Damage;
using format::DamageKind;
using format::kInnerNode;
using format::kSharedReference;
using format::OctreeNode;

using Found = std::optional<Damage>;

/// A fact of one element that the geometry does not bear out.
Damage wrong_fact(std::span<const std::byte> file, SectionId id, std::uint64_t index,
                  std::uint64_t found, std::uint64_t expected) {
    const auto entry = format::find_section(file, id);
    const std::uint64_t at = entry ? entry->offset + index * entry->element_size : 0;
    return {DamageKind::bad_fact, id, at, found, expected};
}

class OctreeCheck {
public:
    OctreeCheck(std::span<const std::byte> file, const Model& model)
        : file_(file), model_(model), grid_(*model.octree_grid()), moved_(model, nullptr) {}

    Found find_damage() {
        if (const Found damage = find_outside()) return damage;
        std::uint64_t places = 0;
        for (std::uint32_t i = 0; i < model_.triangle_count(); ++i) {
            places_.clear();
            if (const Found damage = send_down(moved_.corners(i), i, 0)) return damage;
            if (const Found damage = find_wrong_mark()) return damage;
            places += places_.size();
        }
        if (places == model_.octree_references().size()) return std::nullopt;
        return wrong_fact(file_, SectionId::octree_references, 0, model_.octree_references().size(),
                          places);
    }

private:
    std::span<const std::byte> file_;
    const Model& model_;
    const format::OctreeGrid& grid_;
    MovedModel moved_;
    std::vector<std::uint32_t> places_;  ///< references to the triangle that is on its way

    /// A triangle that is not more than a step inside the cube.
    [[nodiscard]] Found find_outside() const {
        const std::uint32_t last = kOctreeSteps - 1;
        const auto inside = [](double origin, double step, double x) {
            return octree_plane(origin, step, 1) < x && x < octree_plane(origin, step, last);
        };
        for (std::uint32_t i = 0; i < model_.triangle_count(); ++i) {
            for (const Double3& p : moved_.corners(i)) {
                if (!inside(grid_.origin.x, grid_.step, p.x) ||
                    !inside(grid_.origin.y, grid_.step, p.y) ||
                    !inside(grid_.origin.z, grid_.step, p.z)) {
                    return wrong_fact(file_, SectionId::octree_grid, 0, i, 0);
                }
            }
        }
        return std::nullopt;
    }

    /// From a node whose cell the triangle touches.
    Found send_down(const Corners& t, std::uint32_t triangle, std::uint32_t number) {
        const OctreeNode& node = model_.octree_nodes()[number];
        if ((node.count & kInnerNode) == 0) return look_up(triangle, number);
        const std::uint32_t level = level_of(node.key) + 1;
        for (std::uint32_t child = 0; child < 8; ++child) {
            const CellPlace first = octree_place(node.key << 3 | child);
            if (!triangle_touches_box(t, octree_box(grid_, first, level))) continue;
            const std::uint32_t children = node.count & 0xff;
            if ((children >> child & 1) == 0) {
                return wrong_fact(file_, SectionId::octree_nodes, number, children,
                                  children | 1U << child);
            }
            const int before = std::popcount(children & ((1U << child) - 1));
            const std::uint32_t next = node.first + static_cast<std::uint32_t>(before);
            if (const Found damage = send_down(t, triangle, next)) return damage;
        }
        return std::nullopt;
    }

    /// In a leaf that it touches.
    Found look_up(std::uint32_t triangle, std::uint32_t number) {
        const OctreeNode& leaf = model_.octree_nodes()[number];
        const auto list = model_.octree_references().subspan(leaf.first, leaf.count);
        const auto at = std::lower_bound(list.begin(), list.end(), triangle,
                                         [](std::uint32_t reference, std::uint32_t wanted) {
                                             return (reference & ~kSharedReference) < wanted;
                                         });
        if (at == list.end() || (*at & ~kSharedReference) != triangle) {
            return wrong_fact(file_, SectionId::octree_nodes, number, leaf.count, triangle);
        }
        places_.push_back(leaf.first + static_cast<std::uint32_t>(at - list.begin()));
        return std::nullopt;
    }

    [[nodiscard]] Found find_wrong_mark() const {
        for (const std::uint32_t place : places_) {
            const std::uint32_t reference = model_.octree_references()[place];
            const bool marked = (reference & kSharedReference) != 0;
            if (marked != (places_.size() > 1)) {
                return wrong_fact(file_, SectionId::octree_references, place, reference,
                                  reference ^ kSharedReference);
            }
        }
        return std::nullopt;
    }
};

/// A node that its slot's chain does not hold.
Found find_lost_node(std::span<const std::byte> file, const Model& model, SectionId id,
                     std::span<const std::uint32_t> table,
                     std::uint64_t (*slot_of)(std::uint64_t, std::uint32_t) noexcept) {
    const std::uint32_t bits = model.octree_grid()->slot_bits;
    const auto next = table.subspan(std::size_t{1} << bits);
    const auto nodes = model.octree_nodes();
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const std::uint64_t slot = slot_of(nodes[i].key, bits);
        std::uint32_t at = table[slot];
        while (at != 0 && at != i + 1) at = next[at - 1];
        if (at == 0) return wrong_fact(file, id, slot, table[slot], i + 1);
    }
    return std::nullopt;
}

}  // namespace

std::optional<format::Damage> find_list_damage(std::span<const std::byte> file,
                                               const Model& model) {
    if (model.octree_grid() == nullptr) return std::nullopt;
    if (const Found damage = OctreeCheck(file, model).find_damage()) return damage;
    if (model.octree_modulus_table().empty()) return std::nullopt;
    if (const Found damage = find_lost_node(file, model, SectionId::octree_modulus_table,
                                            model.octree_modulus_table(), &format::modulus_slot)) {
        return damage;
    }
    return find_lost_node(file, model, SectionId::octree_mixed_table, model.octree_mixed_table(),
                          &format::mixed_slot);
}

}  // namespace cdprep
