// SPDX-License-Identifier: MIT
#include "cells/find_cone_damage.h"

#include <bit>
#include <cmath>
#include <vector>

#include "cdprep/format/sections.h"
#include "cells/cell_bounds.h"
#include "cells/cone_faces.h"
#include "cells/cone_reach.h"
#include "cells/list_places.h"
#include "cells/tetra_cones.h"
#include "core/moved_model.h"

// Like in find_list_damage.cpp, every triangle goes down into each child whose closed cone it
// touches, stored or not. It must find itself in each leaf. The radii of the leaf and of all nodes
// above it must contain the part of it that certainly lies there.

namespace cdprep {
namespace {

using Found = std::optional<format::Damage>;

class ConeCheck {
public:
    ConeCheck(std::span<const std::byte> file, const Model& model)
        : file_(file),
          model_(model),
          tree_(*model.tetra_tree().tree),
          nodes_(model.tetra_tree().nodes),
          references_(model.tetra_tree().references),
          boxes_(model.tetra_tree().boxes),
          oriented_(model.tetra_tree().oriented),
          frame_(model),
          moved_(model, nullptr),
          scale_(std::ldexp(1.0, model.header().frame_exponent)),
          reach_(nodes_.size()) {
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
                    return format::wrong_fact(file_, SectionId::tetra_tree, 0, tree_.centre_count,
                                              i);
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
            return format::wrong_fact(file_, SectionId::tetra_tree, 0, tree_.centre_count,
                                      at_centre);
        }
        if (places != references_.size()) {
            return format::wrong_fact(file_, SectionId::tetra_references, 0, references_.size(),
                                      places);
        }
        return find_narrow_cone();
    }

private:
    Found send_into_octants(const Corners& t, std::uint32_t triangle) {
        std::uint32_t next = 0;
        for (std::uint32_t key = 8; key < 16; ++key) {
            const bool is_there = next < octants_ && nodes_[next].key == key;
            const std::uint32_t number = is_there ? next++ : 0;
            if (!triangle_touches_cone(t, tree_.centre, tetra_cone(key))) continue;
            if (!is_there) return format::wrong_fact(file_, SectionId::tetra_nodes, 0, 0, key);
            if (const Found damage = send_down(t, triangle, number)) return damage;
        }
        return std::nullopt;
    }

    /// Sends a triangle down from a node whose cone it touches.
    Found send_down(const Corners& t, std::uint32_t triangle, std::uint32_t number) {
        const format::TetraNode& node = nodes_[number];
        if (const Found damage = find_corner_outside(t, number)) return damage;
        if ((node.flags & format::tetra_inner) == 0) return look_up(t, triangle, number);
        const std::uint32_t children = node.flags & format::tetra_children;
        for (std::uint32_t child = 0; child < 4; ++child) {
            const std::uint32_t key = node.key << 2 | child;
            if (!triangle_touches_cone(t, tree_.centre, tetra_cone(key))) continue;
            if ((children >> child & 1) == 0) {
                return format::wrong_fact(file_, SectionId::tetra_nodes, number, children,
                                          children | 1U << child);
            }
            const int before = std::popcount(children & ((1U << child) - 1));
            const std::uint32_t next = node.first + static_cast<std::uint32_t>(before);
            if (const Found damage = send_down(t, triangle, next)) return damage;
        }
        return std::nullopt;
    }

    /// Finds a corner that lies in a node's cone but outside its boxes. Rounding may hide a tiny
    /// excess.
    Found find_corner_outside(const Corners& t, std::uint32_t number) const {
        if (boxes_.empty() || oriented_.empty()) return std::nullopt;
        for (const Double3& p : t) {
            const std::array<double, 3> at = {frame_.frame(0, p.x), frame_.frame(1, p.y),
                                              frame_.frame(2, p.z)};
            const bool in_box = box_holds(number, at);
            if (in_box && oriented_holds(number, at)) continue;
            const TetraCone cone = tetra_cone(nodes_[number].key);
            if (!triangle_touches_cone({p, p, p}, tree_.centre, cone)) continue;
            const SectionId id = in_box ? SectionId::tetra_oriented : SectionId::tetra_boxes;
            const auto section = format::find_section(file_, id);
            const std::uint64_t element = number / format::kTetraBoxStride;
            return format::Damage{format::DamageKind::bad_box, id,
                                  section->offset + element * section->element_size,
                                  number % format::kTetraBoxStride, 0};
        }
        return std::nullopt;
    }
    [[nodiscard]] bool box_holds(std::uint32_t number,
                                 const std::array<double, 3>& p) const noexcept {
        const format::BvhNode& boxes = boxes_[number / format::kTetraBoxStride];
        const std::size_t lane = number % format::kTetraBoxStride;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(p[k] >= double{boxes.lower[k][lane]} && p[k] <= double{boxes.upper[k][lane]})) {
                return false;
            }
        }
        return true;
    }
    [[nodiscard]] bool oriented_holds(std::uint32_t number,
                                      const std::array<double, 3>& p) const noexcept {
        const format::OrientedNode& boxes = oriented_[number / format::kTetraBoxStride];
        const std::size_t lane = number % format::kTetraBoxStride;
        std::array<std::array<double, 3>, 3> axis{};
        for (std::size_t i = 0; i < 3; ++i) {
            axis[0][i] = double{boxes.axis[0][i][lane]};
            axis[1][i] = double{boxes.axis[1][i][lane]};
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const std::size_t m = (i + 2) % 3;
            axis[2][i] = axis[0][j] * axis[1][m] - axis[0][m] * axis[1][j];
        }
        for (std::size_t k = 0; k < 3; ++k) {
            double along = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                along += axis[k][i] * (p[i] - double{boxes.centre[i][lane]});
            }
            if (!(std::fabs(along) <= double{boxes.half[k][lane]})) return false;
        }
        return true;
    }

    /// Looks a triangle up in a leaf that it touches.
    Found look_up(const Corners& t, std::uint32_t triangle, std::uint32_t number) {
        const format::TetraNode& leaf = nodes_[number];
        const auto place = find_reference(references_, leaf.first, leaf.count, triangle);
        if (!place) {
            return format::wrong_fact(file_, SectionId::tetra_nodes, number, leaf.count, triangle);
        }
        places_.push_back(*place);
        add_reach(cone_faces(tetra_cone(leaf.key)), seen_triangle(tree_.centre, t, scale_),
                  reach_[number]);
        return std::nullopt;
    }

    /// Finds a node whose radii exclude something of its own or of its children's.
    Found find_narrow_cone() {
        constexpr double kThird = 0.57735026918962576;  // 1 / sqrt(3)
        constexpr double kRounding = 0x1p-50;           // of that and of the product
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            const format::TetraNode& node = nodes_[i];
            if ((node.flags & format::tetra_inner) != 0) {
                for (std::size_t k = 0; k < node.count; ++k) {
                    reach_[i].add(reach_[node.first + k]);
                }
            }
            const double nearest = reach_[i].least * kThird * (1 + kRounding);
            const double farthest = reach_[i].greatest * kThird * (1 - kRounding);
            if (nearest < node.radius_min || farthest > node.radius_max) {
                format::Damage damage = format::wrong_fact(file_, SectionId::tetra_nodes, i, i, 0);
                damage.kind = format::DamageKind::bad_box;
                return damage;
            }
        }
        return std::nullopt;
    }

    std::span<const std::byte> file_;
    const Model& model_;
    const format::TetraTree& tree_;
    std::span<const format::TetraNode> nodes_;
    std::span<const std::uint32_t> references_;
    std::span<const format::BvhNode> boxes_;
    std::span<const format::OrientedNode> oriented_;
    FrameOf frame_;
    MovedModel moved_;
    double scale_;                  ///< frame units per model unit
    std::vector<ConeReach> reach_;  ///< by node
    std::uint32_t octants_ = 0;
    std::vector<std::uint32_t> places_;  ///< references to the current triangle
};

}  // namespace

std::optional<format::Damage> find_cone_damage(std::span<const std::byte> file,
                                               const Model& model) {
    if (model.tetra_tree().tree == nullptr) return std::nullopt;
    return ConeCheck(file, model).find_damage();
}

}  // namespace cdprep
