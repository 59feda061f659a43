// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <span>

#include "cdprep/contacts.h"

/// Fills Bullet's manifolds of two objects with the contacts of two models: one manifold for each
/// cluster of contacts. `pair` places both models in the world, where the objects are. `manifolds`
/// holds what the last call left there: points that persist keep their impulses, so the solver
/// starts from them. `tolerance` should be at least the way the bodies approach in one step.
cdprep::ContactsVerdict fill_manifolds(const cdprep::Pair& pair, cdprep::Workspace& workspace,
                                       double tolerance, const btCollisionObject& a,
                                       const btCollisionObject& b, btDispatcher& dispatcher,
                                       btManifoldArray& manifolds);

/// The same for contacts that were computed before, as by cdprep::Scene. They are in the world and
/// have manifolds; `a` is their A.
void set_manifolds(std::span<const cdprep::Contact> contacts, const btCollisionObject& a,
                   const btCollisionObject& b, btDispatcher& dispatcher,
                   btManifoldArray& manifolds);
