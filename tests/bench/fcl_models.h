// SPDX-License-Identifier: MIT
#pragma once

#include <fcl/fcl.h>

#include <span>
#include <vector>

#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

inline std::vector<fcl::Vector3d> fcl_points(std::span<const format::Float3> positions) {
    std::vector<fcl::Vector3d> points;
    for (const format::Float3& p : positions) points.emplace_back(p.x, p.y, p.z);
    return points;
}

/// Triangles as FCL keeps them.
template <class Volume>
fcl::BVHModel<Volume> fcl_model(const std::vector<fcl::Vector3d>& points,
                                std::span<const format::Triangle> corners) {
    std::vector<fcl::Triangle> triangles;
    for (const format::Triangle& t : corners) {
        triangles.emplace_back(t.vertex[0], t.vertex[1], t.vertex[2]);
    }
    fcl::BVHModel<Volume> made;
    made.beginModel(static_cast<int>(triangles.size()), static_cast<int>(points.size()));
    made.addSubModel(points, triangles);
    made.endModel();
    return made;
}

/// The same for a model's triangles, in the tree order.
template <class Volume>
fcl::BVHModel<Volume> fcl_model(const Model& model) {
    std::vector<fcl::Vector3d> points = fcl_points(model.mesh().positions_f32);
    for (const format::Double3& p : model.mesh().positions_f64) points.emplace_back(p.x, p.y, p.z);
    return fcl_model<Volume>(points, model.mesh().triangles);
}

/// Moves all points; `scratch` is room for them.
template <class Volume>
void fcl_refit(fcl::BVHModel<Volume>& model, std::span<const format::Float3> positions,
               std::vector<fcl::Vector3d>& scratch) {
    scratch.clear();
    for (const format::Float3& p : positions) scratch.emplace_back(p.x, p.y, p.z);
    model.beginReplaceModel();
    model.replaceSubModel(scratch);
    model.endReplaceModel(true, true);
}

inline fcl::Transform3d fcl_transform(const Pose& pose) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            transform.linear()(row, column) =
                pose.rotation()[static_cast<std::size_t>(3 * row + column)];
        }
    }
    const Double3& t = pose.translation();
    transform.translation() = fcl::Vector3d(t.x, t.y, t.z);
    return transform;
}

}  // namespace cdprep
