// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cdprep/exact/predicates.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::study {

[[nodiscard]] Corners stored_corners(const MeshView& mesh, std::uint32_t triangle);
[[nodiscard]] Corners moved(const Corners& t, const Pose& pose);
[[nodiscard]] Pose a_from_b_of(const Placement& placement);

/// The groups of the BVH: a leaf has up to 8 triangles, a cluster up to 64.
inline constexpr std::uint32_t kLeaf = 1;
inline constexpr std::uint32_t kCluster = 2;

/// Groups of up to 8^height triangles of a model. Group i has the triangles from i * 8^height on,
/// in tree order.
struct TriangleGroups {
    std::uint32_t height = kLeaf;
    std::vector<std::uint32_t> numbers;  ///< ascending

    [[nodiscard]] bool has(std::uint32_t triangle) const;
    [[nodiscard]] std::size_t triangles_of(const Model& model) const;
};

/// The oriented box of one model among the triangles of another. A triangle beyond one of its six
/// planes touches no triangle in the box. The rest is the potentially colliding set (PCS) of Y.
/// Ponce Atencio, "Some techniques to speed up collision detection".
class PotentialSet {
public:
    /// The box is A's, the triangles are B's. A model without the section `bounds` gets the root
    /// box of its BVH.
    PotentialSet(const Model& a, const Model& b, const Placement& placement);

    /// Returns true if no plane clips a triangle of B, given by its stored corners.
    [[nodiscard]] bool holds(const Corners& t) const;

    /// Returns the groups of B whose boxes, and all boxes above them, no plane clips. With fewer
    /// levels than `height`, the whole model is one group.
    [[nodiscard]] TriangleGroups groups(std::uint32_t height) const;

private:
    /// The points p of B with |normal * p + offset| <= limit.
    struct Slab {
        Double3 normal;
        double offset;
        double limit;
    };
    void add_below(std::uint32_t height, std::uint32_t index, TriangleGroups& groups) const;
    [[nodiscard]] bool clips(const format::BvhNode& node, std::uint32_t lane) const;

    const Model& b_;
    std::array<Slab, 3> slab_{};
};

/// Groups of two models.
struct GroupsOfBoth {
    TriangleGroups a;
    TriangleGroups b;
};

/// Returns the groups of each model in boxes that the other's oriented box does not clip.
[[nodiscard]] GroupsOfBoth groups_in_boxes(const Model& a, const Model& b,
                                           const Placement& placement, std::uint32_t height);

/// Returns those groups whose extents meet others along all of 13 directions. Along each direction
/// it is that of any group of the other model. The directions are those of a 26-DOP.
[[nodiscard]] GroupsOfBoth groups_in_slabs(const Model& a, const Model& b,
                                           const Placement& placement, const GroupsOfBoth& groups);

}  // namespace cdprep::study
