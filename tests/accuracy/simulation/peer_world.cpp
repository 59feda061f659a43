// SPDX-License-Identifier: MIT
// Bullet with its own shapes: primitives, or GImpact for every mesh.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>

#include "accuracy/simulation/worlds.h"

namespace cdprep::test {
namespace {

btVector3 bullet(const Double3& p) {
    return {btScalar(p.x), btScalar(p.y), btScalar(p.z)};
}
Double3 doubles(const btVector3& p) {
    return {p.x(), p.y(), p.z()};
}

class PeerWorld final : public World {
public:
    PeerWorld(Engine engine, const dynamics::DynamicsOptions& options)
        : engine_(engine),
          substep_s_(btScalar(options.step_s / options.substeps)),
          substeps_(options.substeps) {
        world_.setGravity(bullet(options.gravity));
        world_.getSolverInfo().m_numIterations = static_cast<int>(options.iterations);
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    }
    ~PeerWorld() override {
        for (auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    PeerWorld(const PeerWorld&) = delete;
    PeerWorld& operator=(const PeerWorld&) = delete;

    std::uint32_t add(const Actor& actor) override {
        shapes_.push_back(shape_of(actor));
        btVector3 inertia(0, 0, 0);
        if (actor.mass > 0) shapes_.back()->calculateLocalInertia(btScalar(actor.mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(actor.mass), nullptr,
                                                      shapes_.back().get(), inertia);
        info.m_friction = btScalar(std::sqrt(actor.friction));  // Bullet multiplies
        info.m_restitution = btScalar(std::sqrt(actor.restitution));
        info.m_linearDamping = info.m_angularDamping = btScalar(actor.damping);
        info.m_startWorldTransform =
            btTransform(btQuaternion(bullet(actor.axis), btScalar(actor.angle)), bullet(actor.at));
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        bodies_.back()->setLinearVelocity(bullet(actor.velocity));
        bodies_.back()->setAngularVelocity(bullet(actor.turn));
        // Bullet sweeps convex shapes alone. The sphere that it sweeps is the whole one.
        if (actor.is_continuous && actor.form == Form::sphere) {
            bodies_.back()->setCcdMotionThreshold(btScalar(actor.radius / 2));
            bodies_.back()->setCcdSweptSphereRadius(btScalar(actor.radius));
        }
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(bodies_.back().get());
        return static_cast<std::uint32_t>(bodies_.size() - 1);
    }
    void step() override {
        for (std::uint32_t i = 0; i < substeps_; ++i) world_.stepSimulation(substep_s_, 0);
    }
    Double3 position(std::uint32_t body) const override {
        return doubles(bodies_[body]->getCenterOfMassPosition());
    }
    Double3 velocity(std::uint32_t body) const override {
        return doubles(bodies_[body]->getLinearVelocity());
    }
    Double3 angular_velocity(std::uint32_t body) const override {
        return doubles(bodies_[body]->getAngularVelocity());
    }

    Double3 spin(std::uint32_t body) const override {
        const btRigidBody& rigid = *bodies_[body];
        return doubles(rigid.getWorldTransform().getBasis().transpose() *
                       rigid.getAngularVelocity());
    }

private:
    std::unique_ptr<btCollisionShape> shape_of(const Actor& actor) {
        if (engine_ == Engine::bullet && actor.form == Form::box) {
            return std::make_unique<btBoxShape>(bullet(actor.half));
        }
        if (engine_ == Engine::bullet && actor.form == Form::sphere) {
            return std::make_unique<btSphereShape>(btScalar(actor.radius));
        }
        const TestMesh mesh = mesh_of(actor);
        meshes_.push_back(std::make_unique<btTriangleMesh>());
        for (const Triangle& t : mesh.triangles) {
            meshes_.back()->addTriangle(bullet(mesh.positions[t.vertex[0]]),
                                        bullet(mesh.positions[t.vertex[1]]),
                                        bullet(mesh.positions[t.vertex[2]]));
        }
        if (actor.mass == 0 && engine_ == Engine::bullet) {
            return std::make_unique<btBvhTriangleMeshShape>(meshes_.back().get(), true);
        }
        auto shape = std::make_unique<btGImpactMeshShape>(meshes_.back().get());
        shape->updateBound();
        return shape;
    }

    Engine engine_;
    btScalar substep_s_;
    std::uint32_t substeps_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

const char* name_of(Engine engine) {
    switch (engine) {
        case Engine::cdprep:
            return "cdprep";
        case Engine::bullet:
            return "Bullet primitive";
        case Engine::gimpact:
            break;
    }
    return "Bullet GImpact";
}

std::unique_ptr<World> make_peer_world(Engine engine, const dynamics::DynamicsOptions& options) {
    return std::make_unique<PeerWorld>(engine, options);
}

}  // namespace cdprep::test
