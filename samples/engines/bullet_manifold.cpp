// SPDX-License-Identifier: MIT
// Bullet's contact manifolds from cdprep's contacts. Call fill_manifolds() from processCollision()
// of a btCollisionAlgorithm of yours, or set_manifolds() where you have contacts already.
#include "bullet_manifold.h"

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <array>
#include <cstring>
#include <span>

namespace {

constexpr std::uint32_t kMost = 64;           // contacts a pair
constexpr double kClusterAngle = 0.26179939;  // 15 degrees

btVector3 bullet_vector(const cdprep::Double3& p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

/// A point with both ids, in the four numbers that Bullet keeps for the user's parts.
btManifoldPoint bullet_point(const cdprep::Contact& contact, const cdprep::ManifoldPoint& point,
                             const btCollisionObject& a, const btCollisionObject& b) {
    const btVector3 on_a = bullet_vector(point.on_a), on_b = bullet_vector(point.on_b);
    // Ours points from A to B, Bullet's from B to A. A distance above 0 stops B at A, not earlier.
    btManifoldPoint made(a.getWorldTransform().invXform(on_a), b.getWorldTransform().invXform(on_b),
                         -bullet_vector(contact.normal), static_cast<btScalar>(point.distance));
    made.m_positionWorldOnA = on_a;
    made.m_positionWorldOnB = on_b;
    made.m_combinedFriction = btManifoldResult::calculateCombinedFriction(&a, &b);
    made.m_combinedRestitution = btManifoldResult::calculateCombinedRestitution(&a, &b);
    std::memcpy(&made.m_partId0, &contact.id, sizeof(int));
    std::memcpy(&made.m_partId1, reinterpret_cast<const char*>(&contact.id) + 4, sizeof(int));
    std::memcpy(&made.m_index0, &point.id, sizeof(int));
    std::memcpy(&made.m_index1, reinterpret_cast<const char*>(&point.id) + 4, sizeof(int));
    return made;
}

/// Takes the impulses of the point with the same ids, if there was one.
void take_impulses(const btAlignedObjectArray<btManifoldPoint>& last, btManifoldPoint& point) {
    for (int i = 0; i < last.size(); ++i) {
        const btManifoldPoint& p = last[i];
        if (p.m_partId0 != point.m_partId0 || p.m_partId1 != point.m_partId1) continue;
        if (p.m_index0 != point.m_index0 || p.m_index1 != point.m_index1) continue;
        point.m_appliedImpulse = p.m_appliedImpulse;
        point.m_appliedImpulseLateral1 = p.m_appliedImpulseLateral1;
        point.m_appliedImpulseLateral2 = p.m_appliedImpulseLateral2;
        point.m_lateralFrictionDir1 = p.m_lateralFrictionDir1;
        point.m_lateralFrictionDir2 = p.m_lateralFrictionDir2;
        point.m_lifeTime = p.m_lifeTime + 1;
        return;
    }
}

/// Empties the manifolds, and returns the points they had.
btAlignedObjectArray<btManifoldPoint> take_points(btManifoldArray& manifolds) {
    btAlignedObjectArray<btManifoldPoint> points;
    for (int m = 0; m < manifolds.size(); ++m) {
        for (int p = 0; p < manifolds[m]->getNumContacts(); ++p) {
            points.push_back(manifolds[m]->getContactPoint(p));
        }
        manifolds[m]->clearManifold();
    }
    return points;
}

}  // namespace

void set_manifolds(std::span<const cdprep::Contact> contacts, const btCollisionObject& a,
                   const btCollisionObject& b, btDispatcher& dispatcher,
                   btManifoldArray& manifolds) {
    const btAlignedObjectArray<btManifoldPoint> last = take_points(manifolds);
    int used = 0;
    for (const cdprep::Contact& contact : contacts) {
        if (contact.flags & cdprep::contact_from_behind) continue;  // it must not push
        if (used == manifolds.size()) manifolds.push_back(dispatcher.getNewManifold(&a, &b));
        for (const auto& point : std::span(contact.points).first(contact.point_count)) {
            btManifoldPoint made = bullet_point(contact, point, a, b);
            take_impulses(last, made);
            manifolds[used]->addManifoldPoint(made);
        }
        ++used;
    }
    for (; manifolds.size() > used; manifolds.pop_back()) {
        dispatcher.releaseManifold(manifolds[manifolds.size() - 1]);
    }
}

cdprep::ContactsVerdict fill_manifolds(const cdprep::Pair& pair, cdprep::Workspace& workspace,
                                       double tolerance, const btCollisionObject& a,
                                       const btCollisionObject& b, btDispatcher& dispatcher,
                                       btManifoldArray& manifolds) {
    std::array<cdprep::Contact, kMost> room;
    const auto verdict = contacts(pair, workspace, room,
                                  {.tolerance = tolerance,
                                   .manifold = cdprep::Manifold::four,
                                   .most = kMost,
                                   .cluster_angle = kClusterAngle});
    set_manifolds(std::span(room).first(verdict.count), a, b, dispatcher, manifolds);
    return verdict;
}
