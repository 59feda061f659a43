// SPDX-License-Identifier: MIT
#include "find_cone_damage.h"

#include <bit>
#include <vector>

#include "list_places.h"
#include "moved_model.h"
#include "tetra_cones.h"

// As find_list_damage.cpp: every triangle goes down into each child whose closed cone it
// touches, stored or not, and must find itself in each leaf.

namespace cdprep {
namespace {

using Found = std::optional<format::Damage>;

class ConeCheck {
public:
    ConeCheck(std::span<const std::byte> file, const Model& model)
        : file_(file),
          model_(model),
          tree_(*model.tetra_tree()),
          nodes_(model.tetra_nodes()),
          references_(model.tetra_references()),
          moved_(model, nullptr) {
        while (octants_ < nodes_.size() && nodes_[octants_].key < 16) ++octants_;
    }

    Found find_damage() {
        std::uint64_t places = tree_.centre_count;
        std::uint32_t at_centre = 0;
        for (std::uint32_t i = 0; i < model_.triangle_count(); ++i) {
            const Corners t = moved_.corners(i);
            const Double3& c = tree_.centre;
            if (triangles_touch({c, c, c}, t)) {
                if (!find_reference(references_, 0, tree_.centre_count, i)) {
                    return wrong_fact(file_, SectionId::tetra_tree, 0, tree_.centre_count, i);
                }
                ++at_centre;
                continue;
            }
            places_.clear();
            if (const Found damage = send_into_octants(t, i)) return damage;
            if (const Found damage =
                    find_wrong_mark(file_, SectionId::tetra_references, references_, places_)) {
                return damage;
            }
            places += places_.size();
        }
        if (at_centre != tree_.centre_count) {
            return wrong_fact(file_, SectionId::tetra_tree, 0, tree_.centre_count, at_centre);
        }
        if (places == references_.size()) return std::nullopt;
        return wrong_fact(file_, SectionId::tetra_references, 0, references_.size(), places);
    }

private:
    Found send_into_octants(const Corners& t, std::uint32_t triangle) {
        std::uint32_t next = 0;
        for (std::uint32_t key = 8; key < 16; ++key) {
            const bool is_there = next < octants_ && nodes_[next].key == key;
            const std::uint32_t number = is_there ? next++ : 0;
            if (!triangle_touches_cone(t, tree_.centre, tetra_cone(key))) continue;
            if (!is_there) return wrong_fact(file_, SectionId::tetra_nodes, 0, 0, key);
            if (const Found damage = send_down(t, triangle, number)) return damage;
        }
        return std::nullopt;
    }

    /// From a node whose cone the triangle touches.
    Found send_down(const Corners& t, std::uint32_t triangle, std::uint32_t number) {
        const format::TetraNode& node = nodes_[number];
        if ((node.flags & format::tetra_inner) == 0) return look_up(triangle, number);
        const std::uint32_t children = node.flags & format::tetra_children;
        for (std::uint32_t child = 0; child < 4; ++child) {
            const std::uint32_t key = node.key << 2 | child;
            if (!triangle_touches_cone(t, tree_.centre, tetra_cone(key))) continue;
            if ((children >> child & 1) == 0) {
                return wrong_fact(file_, SectionId::tetra_nodes, number, children,
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
        const format::TetraNode& leaf = nodes_[number];
        const auto place = find_reference(references_, leaf.first, leaf.count, triangle);
        if (!place) {
            return wrong_fact(file_, SectionId::tetra_nodes, number, leaf.count, triangle);
        }
        places_.push_back(*place);
        return std::nullopt;
    }

    std::span<const std::byte> file_;
    const Model& model_;
    const format::TetraTree& tree_;
    std::span<const format::TetraNode> nodes_;
    std::span<const std::uint32_t> references_;
    MovedModel moved_;
    std::uint32_t octants_ = 0;
    std::vector<std::uint32_t> places_;  ///< references to the triangle that is on its way
};

}  // namespace

std::optional<format::Damage> find_cone_damage(std::span<const std::byte> file,
                                               const Model& model) {
    if (model.tetra_tree() == nullptr) return std::nullopt;
    return ConeCheck(file, model).find_damage();
}

}  // namespace cdprep
