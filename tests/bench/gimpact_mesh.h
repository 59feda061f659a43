// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <memory>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep {

/// A mesh that deforms, as Bullet's GImpact keeps it: without a margin.
class GImpactMesh {
public:
    GImpactMesh(std::span<const format::Float3> positions,
                std::span<const format::Triangle> triangles)
        : points_(3 * positions.size()) {
        for (const format::Triangle& t : triangles) {
            for (const std::uint32_t v : t.vertex) corners_.push_back(static_cast<int>(v));
        }
        set(positions);
        arrays_ = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(triangles.size()), corners_.data(), static_cast<int>(3 * sizeof(int)),
            static_cast<int>(positions.size()), points_.data(),
            static_cast<int>(3 * sizeof(btScalar)));
        shape_ = std::make_unique<btGImpactMeshShape>(arrays_.get());
        shape_->setMargin(0);
        shape_->updateBound();
    }
    void refit(std::span<const format::Float3> positions) {
        set(positions);
        shape_->postUpdate();
        shape_->updateBound();
    }
    /// Returns the triangles and their hierarchy.
    [[nodiscard]] btGImpactMeshShapePart& part() {
        return *shape_->getMeshPart(0);
    }

private:
    void set(std::span<const format::Float3> positions) {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            points_[3 * i] = positions[i].x;
            points_[3 * i + 1] = positions[i].y;
            points_[3 * i + 2] = positions[i].z;
        }
    }

    std::vector<btScalar> points_;
    std::vector<int> corners_;
    std::unique_ptr<btTriangleIndexVertexArray> arrays_;
    std::unique_ptr<btGImpactMeshShape> shape_;
};

}  // namespace cdprep
