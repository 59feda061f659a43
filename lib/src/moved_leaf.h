// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "triangle_contact.h"

namespace cdprep {

/// An axis-aligned box in double precision.
struct Box3 {
    Double3 lower;
    Double3 upper;
};

/// Closed: touching boxes overlap.
inline bool overlap(const Box3& a, const Box3& b) noexcept {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
           b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

/// A model as one query sees it: where its vertices are after moving.
struct MovedModel {
    const Model* model;
    const Pose* pose;  ///< null: the model stays as it is

    /// Corners of triangle `index` of the tree order. Exactly the points that
    /// the query answers for.
    [[nodiscard]] Corners corners(std::uint32_t index) const noexcept {
        const format::Triangle& triangle = model->triangles()[index];
        return {position(triangle.vertex[0]), position(triangle.vertex[1]),
                position(triangle.vertex[2])};
    }
    [[nodiscard]] Double3 position(std::uint32_t vertex) const noexcept {
        const Double3 p = stored_position(*model, vertex);
        return pose == nullptr ? p : moved(*pose, p);
    }

private:
    static Double3 stored_position(const Model& model, std::uint32_t vertex) noexcept {
        if (const auto floats = model.positions_f32(); !floats.empty()) {
            return {floats[vertex].x, floats[vertex].y, floats[vertex].z};
        }
        return model.positions_f64()[vertex];
    }
};

/// The triangles of one leaf, moved once and kept while pairs with it follow.
struct MovedLeaf {
    static constexpr std::uint32_t kNone = 0xffffffff;

    std::uint32_t leaf = kNone;
    std::uint32_t first = 0;  ///< tree order
    std::uint32_t count = 0;
    std::array<Corners, format::kBvhWidth> corners;
    std::array<Box3, format::kBvhWidth> box;
    Box3 all;  ///< of the whole leaf

    void load(const MovedModel& model, std::uint32_t index) noexcept;
};

}  // namespace cdprep
