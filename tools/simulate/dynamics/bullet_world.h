// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cdprep/contacts.h"
#include "cdprep/motion.h"
#include "simulate/dynamics/body_mass.h"
#include "simulate/dynamics/rigid_bodies.h"
#include "simulate/dynamics/rigid_state.h"

namespace cdprep::dynamics {

// Bullet has the velocities and solves for impulses. Everything else is done here: contacts,
// islands, the motion in double, and bounces.

inline btVector3 bullet(const Double3& p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}
inline Double3 doubles(const btVector3& p) {
    return {p.x(), p.y(), p.z()};
}

/// A body as both sides know it.
struct BulletBody {
    BulletBody(const RigidBody& description, const BodyMass& its_mass);

    /// Tells Bullet where the body is.
    void place(const RigidState& next, const Pose& next_pose);

    RigidBody given;
    BodyMass mass;
    RigidState state;
    Pose pose;
    std::optional<Motion> drive;  ///< of a driven body, in this frame
    Double3 spin{};               ///< Bullet's angular velocity, with the digits that it rounds off
    Double3 push{};               ///< velocities that only undo overlap, in this substep
    Double3 push_turn{};
    bool touches = false;                  ///< some impulse acts on it in this substep
    std::unique_ptr<btSphereShape> shape;  ///< only its radius matters
    std::unique_ptr<btRigidBody> rigid;
};

using Bodies = std::vector<std::unique_ptr<BulletBody>>;

inline BulletBody& body_of(const btCollisionObject& object) {
    return *static_cast<BulletBody*>(object.getUserPointer());
}

/// The solver, which also keeps the impulses of friction, and tells the velocities of pushes.
class ImpulseSolver final : public btSequentialImpulseConstraintSolver {
protected:
    void convertContacts(btPersistentManifold** manifolds, int count,
                         const btContactSolverInfo& info) override;
    btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                           const btContactSolverInfo& info) override;

private:
    void start_friction(const btSolverConstraint& contact, int friction, btScalar impulse);
};

/// What happens in a substep besides the solver.
class SubstepParts {
public:
    virtual ~SubstepParts() = default;
    virtual void find_contacts() = 0;
    virtual void move_bodies(double substep_s) = 0;
};

/// Bullet's world without its collision detection.
class ImpulseWorld final : public btDiscreteDynamicsWorld {
public:
    ImpulseWorld(SubstepParts& parts, btDispatcher& dispatcher, btBroadphaseInterface& broadphase,
                 btConstraintSolver& solver, btCollisionConfiguration& configuration)
        : btDiscreteDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration),
          parts_(parts) {}

    void performDiscreteCollisionDetection() override {
        parts_.find_contacts();
    }

protected:
    void saveKinematicState(btScalar) override {}  // velocities of driven bodies are known
    void createPredictiveContacts(btScalar) override {}
    void calculateSimulationIslands() override;
    void integrateTransforms(btScalar substep_s) override {
        parts_.move_bodies(double{substep_s});
    }

private:
    SubstepParts& parts_;
};

/// A contact that bounces if its impulse turns out positive.
struct Bounce {
    btManifoldPoint* point;
    btRigidBody* a;
    btRigidBody* b;
    btVector3 arm_a, arm_b;  ///< from the centres to the contact, before the bodies move
    double speed;            ///< of the approach at the surface
    double impulse = 0;      ///< of the whole impact
};

/// The manifolds of all pairs of bodies.
class Manifolds {
public:
    Manifolds(btCollisionDispatcher& dispatcher, const DynamicsOptions& options)
        : dispatcher_(dispatcher), options_(options) {}
    ~Manifolds();
    Manifolds(const Manifolds&) = delete;
    Manifolds& operator=(const Manifolds&) = delete;

    /// Begins a list of pairs, which come in order.
    void begin();
    void set(BulletBody& a, BulletBody& b, std::pair<std::uint32_t, std::uint32_t> pair,
             std::span<const Contact> contacts, DynamicsCounts& counts);
    /// Drops the pairs that were not listed.
    void end();

    /// Notes which bodies feel an impulse. Call it after the solver.
    void mark_touched() const;
    /// Gives the points that hit their rebound.
    void bounce();
    [[nodiscard]] std::vector<BodyContact> listed() const;

private:
    struct PairManifolds {
        btManifoldArray manifolds;
        bool is_listed = false;
    };

    /// Returns the contact with distances that are measured from where bodies rest.
    [[nodiscard]] Contact adapted(const Contact& contact, DynamicsCounts& counts) const;
    void prepare(btManifoldPoint& point, BulletBody& a, BulletBody& b);
    void release(btManifoldArray& manifolds);
    template <class Visit>
    void visit_points(const Visit& visit) const;

    btCollisionDispatcher& dispatcher_;
    DynamicsOptions options_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, PairManifolds> pairs_;
    std::vector<Contact> adapted_;
    std::vector<Bounce> bounces_;
};

}  // namespace cdprep::dynamics
