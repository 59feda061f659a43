// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstdint>

#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "core/moved_point.h"
#include "exact/box3.h"

namespace cdprep {

/// A model and its vertices after moving, as one query sees them.
struct MovedModel {
    const Model* model;
    const Pose* pose;  ///< null: the model does not move

    MovedModel(const Model& of, const Pose* by) noexcept
        : model(&of),
          pose(by),
          exact_leaves_(of.has_exact_leaves() ? of.bvh().leaves.data() : nullptr),
          triangles_(of.mesh().triangles.data()),
          floats_(of.mesh().positions_f32.empty() ? nullptr : of.mesh().positions_f32.data()),
          doubles_(of.mesh().positions_f64.data()) {}

    /// Returns the corners of triangle `index` in tree order. These are exactly the points for
    /// which the query's answer is exact.
    [[nodiscard]] Corners corners(std::uint32_t index) const noexcept {
        assert(index < model->triangle_count());
        if (exact_leaves_ != nullptr) {
            const format::BvhLeaf& leaf = exact_leaves_[index / format::kBvhWidth];
            const std::uint32_t lane = index % format::kBvhWidth;
            return {at(leaf, 0, lane), at(leaf, 1, lane), at(leaf, 2, lane)};
        }
        const format::Triangle& triangle = triangles_[index];
        return {position(triangle.vertex[0]), position(triangle.vertex[1]),
                position(triangle.vertex[2])};
    }
    [[nodiscard]] Double3 position(std::uint32_t vertex) const noexcept {
        if (floats_ == nullptr) return placed(doubles_[vertex]);
        return placed({floats_[vertex].x, floats_[vertex].y, floats_[vertex].z});
    }

private:
    [[nodiscard]] Double3 placed(const Double3& p) const noexcept {
        return pose == nullptr ? p : moved_point(*pose, p);
    }
    [[nodiscard]] Double3 at(const format::BvhLeaf& leaf, std::size_t corner,
                             std::size_t lane) const noexcept {
        const auto& rows = leaf.corner[corner];
        return placed({rows[0][lane], rows[1][lane], rows[2][lane]});
    }

    // Cached here: looking them up each time would cost more than the corners themselves.
    const format::BvhLeaf* exact_leaves_;  ///< or null
    const format::Triangle* triangles_;
    const format::Float3* floats_;  ///< or null
    const Double3* doubles_;
};

/// The two models of a query, each with the pose that moves it.
inline MovedModel moved_a(const Model& a, const Placement& placement) noexcept {
    return {a, placement.a_is_moved() ? &placement.pose_a() : nullptr};
}
inline MovedModel moved_b(const Model& b, const Placement& placement) noexcept {
    return {b, placement.b_is_moved() ? &placement.pose_b() : nullptr};
}

}  // namespace cdprep
