// SPDX-License-Identifier: MIT
// Drops a body of convex parts onto the floor z = 0 in Bullet for two seconds, and prints what
// became of it as JSON: drop.mjs in C++.
//
// Usage: drop_bullet COLLIDERS.json X Y Z QX QY QZ QW
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

namespace {

using Json = nlohmann::json;

constexpr btScalar kMargin = btScalar(0.0005);  // metres
constexpr btScalar kStep = btScalar(1) / 240;
constexpr int kSteps = 480;
constexpr double kDensity = 1000;

/// The parts as one shape about the centre of mass.
struct Parts {
    btCompoundShape shape;
    std::vector<std::unique_ptr<btConvexHullShape>> hulls;
    int points = 0;

    Parts(const Json& parts, const btVector3& centre, double unit) {
        for (const Json& part : parts) {
            auto hull = std::make_unique<btConvexHullShape>();
            const auto numbers = part["points"].get<std::vector<double>>();
            const auto metres = [&](std::size_t i) { return btScalar(unit * numbers[i]); };
            for (std::size_t i = 0; i < numbers.size(); i += 3) {
                hull->addPoint({metres(i), metres(i + 1), metres(i + 2)}, false);
            }
            hull->setMargin(kMargin);
            hull->recalcLocalAabb();
            points += hull->getNumPoints();
            shape.addChildShape(btTransform(btQuaternion::getIdentity(), -centre), hull.get());
            hulls.push_back(std::move(hull));
        }
    }
};

Json list(const btVector3& v) {
    return {v.x(), v.y(), v.z()};
}

/// Bullet's world with a floor.
struct World {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btBoxShape box{{50, 50, 1}};
    btRigidBody floor{0, nullptr, &box};

    World() {
        world.setGravity({0, 0, btScalar(-9.81)});
        floor.setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 0, -1}));
        world.addRigidBody(&floor);
    }
    ~World() {
        world.removeRigidBody(&floor);
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;
};

Json drop(const Json& colliders, const std::array<btScalar, 7>& start) {
    const double unit =
        colliders["metres_per_unit"].is_null() ? 1 : colliders["metres_per_unit"].get<double>();
    const Json& mass = colliders["mass"];
    const auto at = mass["centre"].get<std::array<double, 3>>();
    const btVector3 centre(btScalar(unit * at[0]), btScalar(unit * at[1]), btScalar(unit * at[2]));
    Parts parts(colliders["parts"], centre, unit);
    const double volume = unit * unit * unit * mass["volume"].get<double>();
    btVector3 inertia(0, 0, 0);
    parts.shape.calculateLocalInertia(btScalar(kDensity * volume), inertia);
    World world;
    btRigidBody body(btScalar(kDensity * volume), nullptr, &parts.shape, inertia);
    const btQuaternion turn(start[3], start[4], start[5], start[6]);
    const btVector3 origin(start[0], start[1], start[2]);
    body.setCenterOfMassTransform(btTransform(turn, origin + quatRotate(turn, centre)));
    world.world.addRigidBody(&body);
    bool is_finite = true;
    btTransform model;
    for (int i = 0; i < kSteps; ++i) {
        world.world.stepSimulation(kStep, 0);
        model = body.getCenterOfMassTransform() * btTransform(btQuaternion::getIdentity(), -centre);
        is_finite = is_finite && std::isfinite(model.getOrigin().length()) &&
                    std::isfinite(body.getAngularVelocity().length());
    }
    const btQuaternion q = model.getRotation();
    Json result = {{"parts", parts.hulls.size()},
                   {"given", parts.points},
                   {"kept", parts.points},
                   {"mass", 1 / body.getInvMass()},
                   {"is_finite", is_finite},
                   {"position", list(model.getOrigin())},
                   {"quaternion", {q.x(), q.y(), q.z(), q.w()}},
                   {"speed", body.getLinearVelocity().length()},
                   {"spin", body.getAngularVelocity().length()}};
    world.world.removeRigidBody(&body);
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 9) {
        std::fprintf(stderr, "usage: drop_bullet COLLIDERS.json X Y Z QX QY QZ QW\n");
        return 2;
    }
    std::array<btScalar, 7> start{};
    for (std::size_t i = 0; i < start.size(); ++i) start[i] = btScalar(std::atof(argv[2 + i]));
    std::ifstream file(argv[1]);
    std::puts(drop(Json::parse(file), start).dump().c_str());
    return 0;
}
