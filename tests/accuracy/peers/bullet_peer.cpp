// SPDX-License-Identifier: MIT
#ifdef CDPREP_HAVE_BULLET
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <btBulletCollisionCommon.h>

#include <memory>

#include "accuracy/peers/peer.h"

// Debian builds it in float.
namespace cdprep::test {
namespace {

btVector3 in_bullet(const Double3& p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

btTriangleMesh mesh_of(const TestMesh& mesh) {
    btTriangleMesh made;
    for (const Triangle& t : mesh.triangles) {
        made.addTriangle(in_bullet(mesh.positions[t.vertex[0]]),
                         in_bullet(mesh.positions[t.vertex[1]]),
                         in_bullet(mesh.positions[t.vertex[2]]));
    }
    return made;
}

PeerAnswer collide(const TestMesh& a, const TestMesh& b) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broad_phase;
    btCollisionWorld world(&dispatcher, &broad_phase, &configuration);
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
    btTriangleMesh mesh_a = mesh_of(a), mesh_b = mesh_of(b);
    btGImpactMeshShape shape_a(&mesh_a), shape_b(&mesh_b);
    btCollisionObject object_a, object_b;
    for (const auto& [shape, object] :
         {std::pair(&shape_a, &object_a), std::pair(&shape_b, &object_b)}) {
        shape->setMargin(0);
        shape->updateBound();
        object->setCollisionShape(shape);
        object->setWorldTransform(btTransform::getIdentity());
        world.addCollisionObject(object);
    }
    // contactPairTest() never says a thing of these shapes.
    world.performDiscreteCollisionDetection();
    bool hit = false;
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        const btPersistentManifold* const contacts = dispatcher.getManifoldByIndexInternal(i);
        for (int k = 0; k < contacts->getNumContacts(); ++k) {
            hit = hit || contacts->getContactPoint(k).getDistance() <= 0;
        }
    }
    world.removeCollisionObject(&object_a);
    world.removeCollisionObject(&object_b);
    return {hit, std::nullopt};
}

btConvexHullShape hull_of(const Points& points) {
    btConvexHullShape hull;
    for (const Double3& p : points) hull.addPoint(in_bullet(p), false);
    hull.recalcLocalAabb();
    hull.setMargin(0);
    return hull;
}

double hull_distance(const Points& a, const Points& b) {
    const btConvexHullShape hull_a = hull_of(a), hull_b = hull_of(b);
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    btGjkPairDetector detector(&hull_a, &hull_b, &simplex, &depth);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA.setIdentity();
    input.m_transformB.setIdentity();
    btPointCollector found;
    detector.getClosestPoints(input, found, nullptr);
    return found.m_hasResult ? static_cast<double>(found.m_distance) : 0;
}

btTransform in_bullet(const Pose& pose) {
    std::array<btScalar, 9> r;
    for (std::size_t i = 0; i < 9; ++i) r[i] = static_cast<btScalar>(pose.rotation()[i]);
    return btTransform(btMatrix3x3(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]),
                       in_bullet(pose.translation()));
}

enum class ShapeKind : std::uint8_t { gimpact, triangles, hull };

/// A body in Bullet; the shape points to the triangles.
struct BulletBody {
    BulletBody(const ContactBody& body, ShapeKind kind) : triangles(mesh_of(*body.mesh)) {
        if (kind == ShapeKind::gimpact) {
            auto made = std::make_unique<btGImpactMeshShape>(&triangles);
            made->setMargin(0);
            made->updateBound();
            shape = std::move(made);
        } else if (kind == ShapeKind::triangles) {
            shape = std::make_unique<btBvhTriangleMeshShape>(&triangles, true);
            shape->setMargin(0);
        } else {
            shape = std::make_unique<btConvexHullShape>(hull_of(body.mesh->positions));
        }
        object.setCollisionShape(shape.get());
        object.setWorldTransform(in_bullet(body.pose));
    }
    BulletBody(const BulletBody&) = delete;
    BulletBody& operator=(const BulletBody&) = delete;

    btTriangleMesh triangles;
    std::unique_ptr<btCollisionShape> shape;
    btCollisionObject object;
};

PeerContacts contacts_of(const HardContact& hard, ShapeKind kind_a, ShapeKind kind_b) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broad_phase;
    btCollisionWorld world(&dispatcher, &broad_phase, &configuration);
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
    BulletBody a(hard.a, kind_a), b(hard.b, kind_b);
    world.addCollisionObject(&a.object);
    world.addCollisionObject(&b.object);
    world.performDiscreteCollisionDetection();
    std::vector<PeerContact> found;
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        const btPersistentManifold* const points = dispatcher.getManifoldByIndexInternal(i);
        // Its normals point to the first of its two bodies.
        const btScalar sign = points->getBody0() == &a.object ? -1 : 1;
        for (int k = 0; k < points->getNumContacts(); ++k) {
            const btManifoldPoint& point = points->getContactPoint(k);
            const btVector3 n = sign * point.m_normalWorldOnB;
            found.push_back({{n.x(), n.y(), n.z()}, point.getDistance()});
        }
    }
    world.removeCollisionObject(&a.object);
    world.removeCollisionObject(&b.object);
    return found;
}

PeerContacts hull_contacts(const HardContact& hard) {
    return contacts_of(hard, ShapeKind::hull, ShapeKind::hull);
}

/// One is a mesh that stands still, as levels of games are; the other must be convex.
PeerContacts level_contacts(const HardContact& hard) {
    if (hard.b.is_convex) return contacts_of(hard, ShapeKind::triangles, ShapeKind::hull);
    return contacts_of(hard, ShapeKind::hull, ShapeKind::triangles);
}

}  // namespace

void add_bullet(std::vector<Peer>& peers) {
    Peer meshes = {"Bullet-GImpact", collide};
    meshes.contacts = [](const HardContact& hard) {
        return contacts_of(hard, ShapeKind::gimpact, ShapeKind::gimpact);
    };
    peers.push_back(meshes);
    Peer level = {"Bullet-BVH"};
    level.contacts = level_contacts;
    peers.push_back(level);
    Peer hulls = {"Bullet-GJK"};
    hulls.hulls_collide = [](const Points& a, const Points& b) { return hull_distance(a, b) <= 0; };
    hulls.hull_distance = hull_distance;
    hulls.takes_two_hulls = true;
    hulls.contacts = hull_contacts;
    peers.push_back(hulls);
}

}  // namespace cdprep::test
#endif
