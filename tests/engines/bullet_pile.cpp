// SPDX-License-Identifier: MIT
// Five scanned models fall into a box: Bullet moves them by the contacts that the sample function
// fills in. Fails if one leaves the box, or is faster than 2 m/s after the first second. Prints
// what still moves at the end: after 2.5 s, or after 10 s with CDPREP_ALL_POSES=yes. With
// sanitizers it ends soon after the first second.
//
// Usage: bullet_pile [NAME...]; the models are those beside the checkout, or in CDPREP_SHARED.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bullet_shape.h"
#include "study/memory_model.h"
#include "support/meshes.h"
#include "support/rounds.h"
#include "support/seed_mesh.h"
#include "unit/tools/soup_of.h"

namespace cdprep {
namespace {

constexpr double kSize = 0.8;        ///< metres: the diagonal of a falling model
constexpr double kInside = 2.4;      ///< metres: the width of the box
constexpr double kWall = 0.5;        ///< metres: how thick its floor and walls are
constexpr double kHeight = 3;        ///< metres: of its walls
constexpr double kTolerance = 0.01;  ///< metres: a step at 2.4 m/s
constexpr double kMass = 10;
constexpr btScalar kFrame = btScalar(1) / 60;
constexpr int kSubsteps = 4;
constexpr int kFrames = 600;
constexpr int kFirstSecond = 60;  ///< frames
constexpr double kMostSpeed = 2;  ///< m/s after the first second
constexpr double kAtRest = 0.01;  ///< m/s

btVector3 bullet(const Double3& p) {
    return {btScalar(p.x), btScalar(p.y), btScalar(p.z)};
}

/// A mesh with what cdprep and Bullet need of it.
struct Shape {
    study::MemoryModel baked;
    BulletShape shape;

    Shape(const test::TestMesh& mesh, Workspace& workspace)
        : baked(study::make_memory_model(test::mesh_of(mesh), {.pieces = true}).value()),
          shape(baked.model, workspace, btScalar(kTolerance)) {}
};

/// A box about the origin.
test::TestMesh box(const Double3& half) {
    test::TestMesh mesh = test::moved_by(test::unit_cube(), 2, {-1, -1, -1});
    for (Double3& p : mesh.positions) p = {half.x * p.x, half.y * p.y, half.z * p.z};
    return mesh;
}

/// Bullet's world, with all that it points to.
class World {
public:
    explicit World(Workspace& workspace)
        : contacts_(workspace, kTolerance), dispatcher_(&configuration_) {
        dispatcher_.registerCollisionCreateFunc(FAST_CONCAVE_MESH_PROXYTYPE,
                                                FAST_CONCAVE_MESH_PROXYTYPE, &contacts_);
        world_.setGravity({0, 0, btScalar(-9.81)});
        world_.getSolverInfo().m_numIterations = 50;
        world_.getSolverInfo().m_splitImpulse = 1;
        world_.getSolverInfo().m_splitImpulsePenetrationThreshold = 0;
    }
    ~World() {
        for (auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    btRigidBody& add(Shape& shape, double mass, const btTransform& at) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.shape.calculateLocalInertia(btScalar(mass), inertia);
        bodies_.push_back(std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
            btScalar(mass), nullptr, &shape.shape, inertia)));
        btRigidBody& body = *bodies_.back();
        body.setWorldTransform(at);
        body.setInterpolationWorldTransform(at);
        body.setFriction(btScalar(0.6));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(&body);
        return body;
    }
    void step() {
        world_.stepSimulation(kFrame, kSubsteps, kFrame / kSubsteps);
    }

private:
    BulletContacts contacts_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

/// The distance from the origin of the corner that is farthest.
btScalar radius_of(const format::Bounds& box) {
    return bullet({std::max(-box.lower.x, box.upper.x), std::max(-box.lower.y, box.upper.y),
                   std::max(-box.lower.z, box.upper.z)})
        .length();
}

/// The greatest speed that a point of the body can have.
double speed_of(const btRigidBody& body) {
    const auto& shape = static_cast<const BulletShape&>(*body.getCollisionShape());
    return body.getLinearVelocity().length() +
           body.getAngularVelocity().length() * radius_of(*shape.model().record().bounds);
}

bool is_inside(const btRigidBody& body) {
    const btVector3 p = body.getCenterOfMassPosition();
    const double half = kInside / 2;
    return std::abs(p.x()) < half && std::abs(p.y()) < half && p.z() > 0 && p.z() < kHeight;
}

/// Drops five of a model. Returns whether they behave.
bool drop(const std::string& name, Shape& shape, Workspace& workspace) {
    const double side = kInside / 2 + kWall;
    Shape floor(box({side, side, kWall / 2}), workspace),
        across(box({side, kWall / 2, kHeight / 2}), workspace),
        along(box({kWall / 2, side, kHeight / 2}), workspace);
    World world(workspace);
    const auto at = [](double x, double y, double z) {
        return btTransform(btQuaternion::getIdentity(), {btScalar(x), btScalar(y), btScalar(z)});
    };
    world.add(floor, 0, at(0, 0, -kWall / 2));
    for (const int sign : {-1, 1}) {
        world.add(across, 0, at(0, sign * (kInside + kWall) / 2, kHeight / 2));
        world.add(along, 0, at(sign * (kInside + kWall) / 2, 0, kHeight / 2));
    }
    std::vector<btRigidBody*> falling;
    constexpr std::array<Double3, 5> kStarts = {{{-0.55, -0.55, 0.6},
                                                 {0.55, -0.55, 0.6},
                                                 {-0.55, 0.55, 0.6},
                                                 {0.55, 0.55, 0.6},
                                                 {0, 0, 1.1}}};
    for (std::size_t i = 0; i < kStarts.size(); ++i) {
        const btVector3 axis(1, btScalar(i), 2);
        falling.push_back(
            &world.add(shape, kMass,
                       btTransform(btQuaternion(axis.normalized(), btScalar(0.7 * double(i))),
                                   bullet(kStarts[i]))));
    }
    double fastest = 0;
    bool stays = true;
    const int frames = std::max(kFirstSecond + 10, test::rounds(kFrames, 4));
    for (int frame = 0; frame < frames; ++frame) {
        world.step();
        for (const btRigidBody* body : falling) {
            stays = stays && is_inside(*body);
            if (frame < kFirstSecond) continue;
            fastest = std::max(fastest, double{body->getLinearVelocity().length()});
        }
    }
    std::printf("five of %s: %s, at most %.3g m/s after 1 s", name.c_str(),
                stays ? "all stay in the box" : "NOT ALL STAY IN THE BOX", fastest);
    const auto moving = std::count_if(falling.begin(), falling.end(), [](const btRigidBody* body) {
        return speed_of(*body) > kAtRest;
    });
    std::printf("; after %d frames %d move:", frames, static_cast<int>(moving));
    for (const btRigidBody* body : falling) std::printf(" %.3g", speed_of(*body));
    std::printf(" m/s\n");
    return stays && fastest <= kMostSpeed;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"horse", "bunny"};
    bool passes = true;
    for (const std::string& name : names) {
        const auto mesh = cdprep::test::seed_mesh(name);
        if (!mesh) {
            std::printf("skipped: no model %s beside the checkout (set CDPREP_SHARED)\n",
                        name.c_str());
            return 77;
        }
        cdprep::Workspace workspace;
        cdprep::Shape shape(cdprep::test::moved_by(*mesh, cdprep::kSize, {0, 0, 0}), workspace);
        passes = cdprep::drop(name, shape, workspace) && passes;
    }
    return passes ? 0 : 1;
}
