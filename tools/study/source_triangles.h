// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/exact/predicates.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep::study {

/// The triangles of a model by their source numbers. The model must outlive this object.
class SourceTriangles {
public:
    explicit SourceTriangles(const Model& model) : model_(&model) {
        const auto source = model.source().triangle;
        place_.resize(source.size());
        for (std::uint32_t i = 0; i < source.size(); ++i) place_[source[i]] = i;
    }

    [[nodiscard]] const Model& model() const noexcept {
        return *model_;
    }
    /// Returns the place of a triangle in tree order.
    [[nodiscard]] std::uint32_t place(std::uint32_t number) const {
        return place_[number];
    }
    [[nodiscard]] Corners corners(std::uint32_t number) const {
        const auto& vertex = model_->mesh().triangles[place_[number]].vertex;
        return {position(vertex[0]), position(vertex[1]), position(vertex[2])};
    }
    /// Returns the corners in a pose, with the same rounding as in queries.
    [[nodiscard]] Corners corners(std::uint32_t number, const Pose& pose) const {
        const Corners stored = corners(number);
        return {transform_point(pose, stored[0]), transform_point(pose, stored[1]),
                transform_point(pose, stored[2])};
    }

private:
    [[nodiscard]] Double3 position(std::uint32_t vertex) const {
        const MeshView& mesh = model_->mesh();
        if (mesh.positions_f32.empty()) return mesh.positions_f64[vertex];
        const Float3& p = mesh.positions_f32[vertex];
        return {p.x, p.y, p.z};
    }

    const Model* model_;
    std::vector<std::uint32_t> place_;  ///< in tree order
};

}  // namespace cdprep::study
