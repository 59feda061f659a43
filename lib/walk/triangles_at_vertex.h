// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "walk/shape_frame.h"
#include "walk/walk_model.h"

namespace cdprep {

/// A vertex of a model that does not move, in the coordinates of the model's boxes.
class VertexInBoxes {
public:
    VertexInBoxes(const Model& model, std::uint32_t vertex) noexcept {
        const MovedModel still(model, nullptr);
        const Double3 position = still.position(vertex);
        const ShapeFrame frame(still, ShapeFrame::largest(position));
        const FrameVector at = frame.at(position);
        const float margin = kRounding + static_cast<float>(frame.slack());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower_[axis] = static_cast<float>(at[axis]) - margin;
            upper_[axis] = static_cast<float>(at[axis]) + margin;
        }
    }

    /// Returns which boxes of a node may contain the vertex.
    [[nodiscard]] BoxVerdict judge(const format::BvhNode& node) const noexcept {
        std::array<std::uint32_t, format::kBvhWidth> contains;
        contains.fill(~0U);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
                const bool is_above = node.lower[axis][box] > upper_[axis];
                const bool is_below = node.upper[axis][box] < lower_[axis];
                contains[box] &= (is_above | is_below) ? 0U : ~0U;  // without a branch
            }
        }
        BoxVerdict verdict;
        for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
            verdict.near |= contains[box] & (1U << box);
        }
        return verdict;
    }

private:
    /// More than rounding to float and adding the margin take from coordinates within [-1, 1].
    static constexpr float kRounding = 0x1p-21F;

    std::array<float, 3> lower_;
    std::array<float, 3> upper_;
};

/// Calls visit(triangle) for each triangle of a model that has a vertex, in tree order numbers,
/// until it returns false. Returns false if it did. Files have no list of the triangles at a
/// vertex, so this walks the boxes that contain it.
template <class Visit>
bool visit_triangles_at(const Model& model, std::uint32_t vertex, Workspace::Storage& scratch,
                        Visit&& visit) noexcept {
    const VertexInBoxes place(model, vertex);
    const auto triangles = model.mesh().triangles;
    const auto look_at_leaf = [&](const TriangleRun& run) {
        for (std::uint32_t i = run.first; i < run.last; ++i) {
            const auto& [a, b, c] = triangles[i].vertex;
            const bool has_it = (a == vertex) | (b == vertex) | (c == vertex);
            if (has_it && !visit(i)) return false;
        }
        return true;
    };
    return walk_nodes(
        model, scratch, [&](const format::BvhNode& node) { return place.judge(node); },
        look_at_leaf, look_at_leaf);
}

}  // namespace cdprep
