// SPDX-License-Identifier: MIT
// A baked file as Bullet's exact concave shape. bolt_in_hole.cpp uses it.
#include "bullet_shape.h"

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <LinearMath/btAabbUtil2.h>

#include <array>
#include <new>

#include "bullet_manifold.h"
#include "cdprep/points.h"

namespace {

template <class Point>
btVector3 bullet_vector(const Point& p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

cdprep::Double3 double_vector(const btVector3& p) {
    return {double{p.x()}, double{p.y()}, double{p.z()}};
}

/// The rotations of Bullet are of floats, and rigid up to their rounding.
cdprep::Pose pose_of(const btTransform& t) {
    const btMatrix3x3& r = t.getBasis();
    const btVector3& p = t.getOrigin();
    const std::array<double, 16> matrix = {
        r[0].x(), r[0].y(), r[0].z(), p.x(), r[1].x(), r[1].y(), r[1].z(), p.y(),
        r[2].x(), r[2].y(), r[2].z(), p.z(), 0,        0,        0,        1};
    return cdprep::nearest_pose(matrix, 1e-5).value();
}

class ContactAlgorithm final : public btCollisionAlgorithm {
public:
    ContactAlgorithm(const btCollisionAlgorithmConstructionInfo& info, cdprep::Workspace& workspace,
                     double tolerance)
        : btCollisionAlgorithm(info), workspace_(workspace), tolerance_(tolerance) {}
    ~ContactAlgorithm() override {
        for (int m = 0; m < manifolds_.size(); ++m) m_dispatcher->releaseManifold(manifolds_[m]);
    }
    void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                          const btDispatcherInfo& /*info*/, btManifoldResult* /*out*/) override {
        const auto& one = static_cast<const BulletShape&>(*a->getCollisionShape());
        const auto& two = static_cast<const BulletShape&>(*b->getCollisionShape());
        const auto placement = cdprep::Placement::world(pose_of(a->getWorldTransform()),
                                                        pose_of(b->getWorldTransform()));
        fill_manifolds({one.model(), two.model(), placement}, workspace_, tolerance_,
                       *a->getCollisionObject(), *b->getCollisionObject(), *m_dispatcher,
                       manifolds_);
    }
    btScalar calculateTimeOfImpact(btCollisionObject* /*a*/, btCollisionObject* /*b*/,
                                   const btDispatcherInfo& /*info*/,
                                   btManifoldResult* /*out*/) override {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray& all) override {
        for (int m = 0; m < manifolds_.size(); ++m) all.push_back(manifolds_[m]);
    }

private:
    cdprep::Workspace& workspace_;
    double tolerance_;
    btManifoldArray manifolds_;
};

}  // namespace

BulletShape::BulletShape(const cdprep::Model& model, cdprep::Workspace& workspace, btScalar margin)
    : model_(model), workspace_(workspace), places_(model.triangle_number_bound()) {
    // CUSTOM_CONCAVE_SHAPE_TYPE would be the obvious type, but Bullet takes it for a distance field
    // (SDF_SHAPE_PROXYTYPE has the same number) and never asks for triangles.
    m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE;
    setMargin(margin);
    const auto numbers = model.source().triangle;
    for (std::uint32_t place = 0; place < numbers.size(); ++place) {
        places_[numbers[place]] = place;
        for (int i = 0; i < 3; ++i) {
            if (place == 0 && i == 0) lower_ = upper_ = corner(0, 0);
            lower_.setMin(corner(place, i));
            upper_.setMax(corner(place, i));
        }
    }
}

btVector3 BulletShape::corner(std::uint32_t place, int number) const {
    const cdprep::MeshView& mesh = model_.mesh();
    const auto vertex = mesh.triangles[place].vertex[static_cast<std::size_t>(number)];
    if (!mesh.positions_f32.empty()) return bullet_vector(mesh.positions_f32[vertex]);
    return bullet_vector(mesh.positions_f64[vertex]);
}

void BulletShape::processAllTriangles(btTriangleCallback* callback, const btVector3& lower,
                                      const btVector3& upper) const {
    auto visit = [&](std::uint32_t triangle) {
        const std::uint32_t place = places_[triangle];
        std::array<btVector3, 3> corners = {corner(place, 0), corner(place, 1), corner(place, 2)};
        callback->processTriangle(corners.data(), 0, static_cast<int>(triangle));
        return true;
    };
    const cdprep::Box box = {double_vector(lower), double_vector(upper)};
    visit_touching_triangles(model_, box, workspace_, visit);
}

void BulletShape::getAabb(const btTransform& t, btVector3& lower, btVector3& upper) const {
    btTransformAabb(lower_, upper_, getMargin(), t, lower, upper);
}

void BulletShape::calculateLocalInertia(btScalar mass, btVector3& inertia) const {
    const btVector3 d = upper_ - lower_;
    inertia = mass / 12 *
              btVector3(d.y() * d.y() + d.z() * d.z(), d.x() * d.x() + d.z() * d.z(),
                        d.x() * d.x() + d.y() * d.y());
}

btCollisionAlgorithm* BulletContacts::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* /*a*/,
    const btCollisionObjectWrapper* /*b*/) {
    void* const room = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(ContactAlgorithm));
    return new (room) ContactAlgorithm(info, workspace_, tolerance_);
}
