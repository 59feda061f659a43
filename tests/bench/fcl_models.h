// SPDX-License-Identifier: MIT
#pragma once

#include <fcl/fcl.h>

#include <vector>

#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// A model's triangles as FCL keeps them, in the tree order.
template <class Volume>
fcl::BVHModel<Volume> fcl_model(const Model& model) {
    std::vector<fcl::Vector3d> points;
    for (const format::Float3& p : model.mesh().positions_f32) points.emplace_back(p.x, p.y, p.z);
    for (const format::Double3& p : model.mesh().positions_f64) points.emplace_back(p.x, p.y, p.z);
    std::vector<fcl::Triangle> triangles;
    for (const format::Triangle& t : model.mesh().triangles) {
        triangles.emplace_back(t.vertex[0], t.vertex[1], t.vertex[2]);
    }
    fcl::BVHModel<Volume> made;
    made.beginModel(static_cast<int>(triangles.size()), static_cast<int>(points.size()));
    made.addSubModel(points, triangles);
    made.endModel();
    return made;
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
