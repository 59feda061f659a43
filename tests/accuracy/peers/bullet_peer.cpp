// SPDX-License-Identifier: MIT
#ifdef CDPREP_HAVE_BULLET
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <btBulletCollisionCommon.h>

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

}  // namespace

void add_bullet(std::vector<Peer>& peers) {
    peers.push_back({"Bullet-GImpact", collide});
    Peer hulls = {"Bullet-GJK"};
    hulls.hulls_collide = [](const Points& a, const Points& b) { return hull_distance(a, b) <= 0; };
    hulls.hull_distance = hull_distance;
    peers.push_back(hulls);
}

}  // namespace cdprep::test
#endif
