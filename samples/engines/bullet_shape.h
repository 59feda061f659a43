// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include <cstdint>
#include <vector>

#include "cdprep/model.h"
#include "cdprep/workspace.h"

/// The exact surface of a baked model as a shape of Bullet. Bullet's convex shapes meet the
/// triangles that the library finds in the mapped file. No hierarchy is built at load. Bullet
/// computes in float, so corners are rounded to it.
///
/// Needs Ask::touch and Ask::corners. The model and the workspace must outlive the shape. Only one
/// thread at a time may use shapes with one workspace.
class BulletShape final : public btConcaveShape {
public:
    /// Makes the box, and a table of the triangles' places, 4 bytes each.
    BulletShape(const cdprep::Model& model, cdprep::Workspace& workspace, btScalar margin);

    [[nodiscard]] const cdprep::Model& model() const {
        return model_;
    }
    void processAllTriangles(btTriangleCallback* callback, const btVector3& lower,
                             const btVector3& upper) const override;
    void getAabb(const btTransform& t, btVector3& lower, btVector3& upper) const override;
    /// That of the bounding box. Use Model::record().mass, where a file has it, for the exact one.
    void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
    /// A baked model has one size, so the scale is ignored.
    void setLocalScaling(const btVector3& /*scaling*/) override {}
    [[nodiscard]] const btVector3& getLocalScaling() const override {
        return scaling_;
    }
    [[nodiscard]] const char* getName() const override {
        return "cdprep model";
    }

private:
    [[nodiscard]] btVector3 corner(std::uint32_t place, int number) const;

    const cdprep::Model& model_;
    cdprep::Workspace& workspace_;
    btVector3 lower_{0, 0, 0}, upper_{0, 0, 0}, scaling_{1, 1, 1};
    std::vector<std::uint32_t> places_;  ///< by source number, in the order of the file
};

/// Makes the surfaces of two BulletShapes collide, by the library's contacts. Register it:
///
///     dispatcher.registerCollisionCreateFunc(FAST_CONCAVE_MESH_PROXYTYPE,
///                                            FAST_CONCAVE_MESH_PROXYTYPE, &contacts);
///
/// Models need Ask::contacts. Contacts begin at `tolerance`, which should be at least the way that
/// bodies approach in one step. It should be less than the play of a body in a hole. Otherwise
/// edges that pass each other stop the body above the hole. The margins of two shapes must add up
/// to the tolerance or more, because Bullet asks about shapes whose boxes meet.
class BulletContacts final : public btCollisionAlgorithmCreateFunc {
public:
    BulletContacts(cdprep::Workspace& workspace, double tolerance)
        : workspace_(workspace), tolerance_(tolerance) {}
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;

private:
    cdprep::Workspace& workspace_;
    double tolerance_;
};
