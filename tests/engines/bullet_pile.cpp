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
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "bullet_manifold.h"
#include "cdprep/contacts.h"
#include "mesh/find_bounds.h"
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

/// The bounds of a model; cdprep knows its triangles.
class BoundedShape final : public btConcaveShape {
public:
    BoundedShape(const btVector3& lower, const btVector3& upper) : lower_(lower), upper_(upper) {
        m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE;
        setMargin(btScalar(kTolerance));
    }
    void getAabb(const btTransform& t, btVector3& lower, btVector3& upper) const override {
        btTransformAabb(lower_, upper_, getMargin(), t, lower, upper);
    }
    void processAllTriangles(btTriangleCallback*, const btVector3&,
                             const btVector3&) const override {}
    void calculateLocalInertia(btScalar mass, btVector3& inertia) const override {
        const btVector3 d = upper_ - lower_;
        inertia = mass / 12 *
                  btVector3(d.y() * d.y() + d.z() * d.z(), d.x() * d.x() + d.z() * d.z(),
                            d.x() * d.x() + d.y() * d.y());
    }
    void setLocalScaling(const btVector3&) override {}
    [[nodiscard]] const btVector3& getLocalScaling() const override {
        return scaling_;
    }
    [[nodiscard]] const char* getName() const override {
        return "cdprep model";
    }
    /// The distance from the origin of the corner that is farthest.
    [[nodiscard]] btScalar radius() const {
        return btVector3(std::max(-lower_.x(), upper_.x()), std::max(-lower_.y(), upper_.y()),
                         std::max(-lower_.z(), upper_.z()))
            .length();
    }

private:
    btVector3 lower_, upper_, scaling_{1, 1, 1};
};

Pose pose_of(const btTransform& t) {
    std::array<double, 16> matrix{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            matrix[static_cast<std::size_t>(4 * row + column)] = t.getBasis()[row][column];
        }
        matrix[static_cast<std::size_t>(4 * row + 3)] = t.getOrigin()[row];
    }
    matrix[15] = 1;
    return nearest_pose(matrix, 1e-5).value();
}

const Model& model_of(const btCollisionObject& object) {
    return *static_cast<const Model*>(object.getUserPointer());
}

/// Asks cdprep for the contacts of two objects, and keeps their manifolds.
class ContactAlgorithm final : public btCollisionAlgorithm {
public:
    ContactAlgorithm(const btCollisionAlgorithmConstructionInfo& info, Workspace& workspace)
        : btCollisionAlgorithm(info), workspace_(workspace) {}
    ~ContactAlgorithm() override {
        for (int m = 0; m < manifolds_.size(); ++m) m_dispatcher->releaseManifold(manifolds_[m]);
    }
    void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                          const btDispatcherInfo&, btManifoldResult*) override {
        const btCollisionObject &one = *a->getCollisionObject(), &two = *b->getCollisionObject();
        const Placement placement =
            Placement::world(pose_of(one.getWorldTransform()), pose_of(two.getWorldTransform()));
        fill_manifolds({model_of(one), model_of(two), placement}, workspace_, kTolerance, one, two,
                       *m_dispatcher, manifolds_);
    }
    btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                   btManifoldResult*) override {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray& all) override {
        for (int m = 0; m < manifolds_.size(); ++m) all.push_back(manifolds_[m]);
    }

private:
    Workspace& workspace_;
    btManifoldArray manifolds_;
};

struct MakeAlgorithm final : btCollisionAlgorithmCreateFunc {
    Workspace workspace;
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper*,
                                                   const btCollisionObjectWrapper*) override {
        void* const room = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(ContactAlgorithm));
        return new (room) ContactAlgorithm(info, workspace);
    }
};

btVector3 bullet(const Double3& p) {
    return {btScalar(p.x), btScalar(p.y), btScalar(p.z)};
}

/// A mesh with what cdprep and Bullet need of it.
struct Shape {
    study::MemoryModel baked;
    std::unique_ptr<BoundedShape> bounds;

    explicit Shape(const test::TestMesh& mesh)
        : baked(study::make_memory_model(test::mesh_of(mesh), {.pieces = true}).value()) {
        const format::Bounds box = convex::find_bounds(baked.ordered);
        bounds = std::make_unique<BoundedShape>(bullet(box.lower), bullet(box.upper));
    }
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
    World() : dispatcher_(&configuration_) {
        dispatcher_.registerCollisionCreateFunc(FAST_CONCAVE_MESH_PROXYTYPE,
                                                FAST_CONCAVE_MESH_PROXYTYPE, &make_);
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
        if (mass > 0) shape.bounds->calculateLocalInertia(btScalar(mass), inertia);
        bodies_.push_back(std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
            btScalar(mass), nullptr, shape.bounds.get(), inertia)));
        btRigidBody& body = *bodies_.back();
        body.setWorldTransform(at);
        body.setInterpolationWorldTransform(at);
        body.setUserPointer(&shape.baked.model);
        body.setFriction(btScalar(0.6));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(&body);
        return body;
    }
    void step() {
        world_.stepSimulation(kFrame, kSubsteps, kFrame / kSubsteps);
    }

private:
    MakeAlgorithm make_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

/// The greatest speed that a point of the body can have.
double speed_of(const btRigidBody& body) {
    const auto& shape = static_cast<const BoundedShape&>(*body.getCollisionShape());
    return body.getLinearVelocity().length() + body.getAngularVelocity().length() * shape.radius();
}

bool is_inside(const btRigidBody& body) {
    const btVector3 p = body.getCenterOfMassPosition();
    const double half = kInside / 2;
    return std::abs(p.x()) < half && std::abs(p.y()) < half && p.z() > 0 && p.z() < kHeight;
}

/// Drops five of a model. Returns whether they behave.
bool drop(const std::string& name, Shape& shape) {
    const double side = kInside / 2 + kWall;
    Shape floor(box({side, side, kWall / 2})), across(box({side, kWall / 2, kHeight / 2})),
        along(box({kWall / 2, side, kHeight / 2}));
    World world;
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
        cdprep::Shape shape(cdprep::test::moved_by(*mesh, cdprep::kSize, {0, 0, 0}));
        passes = cdprep::drop(name, shape) && passes;
    }
    return passes ? 0 : 1;
}
