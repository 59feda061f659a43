// SPDX-License-Identifier: MIT
// Five scanned models fall into a box: Bullet moves them by the contacts that the sample function
// fills in. Fails if one leaves the box, or is faster than 2 m/s after the first second. Prints
// what still moves after ten seconds.
//
// Usage: bullet_pile [NAME...]; the models are those beside the checkout, or in CDPREP_SHARED
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
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "bullet_manifold.h"
#include "cdprep/contacts.h"
#include "import/import_file.h"
#include "mesh/normalize.h"
#include "mesh/weld.h"
#include "study/memory_model.h"
#include "support/shared_models.h"

namespace cdprep {
namespace {

constexpr double kSize = 0.8;         ///< metres: the diagonal of a falling model
constexpr double kInside = 2.4;       ///< metres: the width of the box
constexpr double kWall = 0.5;         ///< metres: how thick its floor and walls are
constexpr double kHeight = 3;         ///< metres: of its walls
constexpr double kTolerance = 0.015;  ///< metres: a step at 3.6 m/s
constexpr double kMass = 10;
constexpr btScalar kFrame = btScalar(1) / 60;
constexpr int kSubsteps = 4;
constexpr int kFrames = 600;
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

std::pair<Double3, Double3> corners_of(const mesh::Mesh& mesh) {
    Double3 lower = mesh.positions[0], upper = lower;
    for (const Double3& p : mesh.positions) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    return {lower, upper};
}

btVector3 bullet(const Double3& p) {
    return {btScalar(p.x), btScalar(p.y), btScalar(p.z)};
}

/// A mesh with what cdprep and Bullet need of it.
struct Shape {
    study::MemoryModel baked;
    std::unique_ptr<BoundedShape> bounds;

    explicit Shape(const mesh::Mesh& mesh)
        : baked(study::make_memory_model(mesh, {.pieces = true}).value()) {
        const auto [lower, upper] = corners_of(mesh);
        bounds = std::make_unique<BoundedShape>(bullet(lower), bullet(upper));
    }
};

/// A box about the origin.
mesh::Mesh box(const Double3& half) {
    mesh::Mesh mesh;
    for (std::uint32_t i = 0; i < 8; ++i) {
        mesh.positions.push_back({(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                                  (i & 4) != 0 ? half.z : -half.z});
        mesh.source_vertex.push_back(i);
    }
    for (const auto& t : {std::array{0U, 2U, 1U},
                          {1U, 2U, 3U},
                          {4U, 5U, 6U},
                          {5U, 7U, 6U},
                          {0U, 1U, 4U},
                          {1U, 5U, 4U},
                          {2U, 6U, 3U},
                          {3U, 6U, 7U},
                          {0U, 4U, 2U},
                          {2U, 4U, 6U},
                          {1U, 3U, 5U},
                          {3U, 7U, 5U}}) {
        mesh.triangles.push_back({t});
    }
    return mesh;
}

/// A seed model about the origin, kSize in diagonal.
mesh::Mesh load(const std::filesystem::path& file) {
    auto soup = import::import_file(file);
    if (!soup) {
        std::fprintf(stderr, "bullet_pile: %s\n", soup.error().message.c_str());
        std::exit(3);
    }
    mesh::normalize(soup.value());
    mesh::Mesh mesh = mesh::weld(soup.value()).mesh;
    const auto [lower, upper] = corners_of(mesh);
    const double size = std::hypot(upper.x - lower.x, upper.y - lower.y, upper.z - lower.z);
    for (Double3& p : mesh.positions) {
        p = {kSize / size * (p.x - (lower.x + upper.x) / 2),
             kSize / size * (p.y - (lower.y + upper.y) / 2),
             kSize / size * (p.z - (lower.z + upper.z) / 2)};
    }
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
    for (int i = 0; i < 5; ++i) {
        const bool is_last = i == 4;
        btTransform start = at(is_last        ? 0
                               : (i & 1) != 0 ? 0.55
                                              : -0.55,
                               is_last        ? 0
                               : (i & 2) != 0 ? 0.55
                                              : -0.55,
                               is_last ? 1.1 : 0.6);
        start.setRotation(
            btQuaternion(btVector3(1, btScalar(i), 2).normalized(), btScalar(0.7 * i)));
        falling.push_back(&world.add(shape, kMass, start));
    }
    double fastest = 0;
    bool stays = true;
    for (int frame = 0; frame < kFrames; ++frame) {
        world.step();
        for (const btRigidBody* body : falling) {
            stays = stays && is_inside(*body);
            if (frame >= 60)
                fastest = std::max(fastest, double{body->getLinearVelocity().length()});
        }
    }
    std::printf("five of %s: %s, at most %.3g m/s after 1 s", name.c_str(),
                stays ? "all stay in the box" : "NOT ALL STAY IN THE BOX", fastest);
    const auto moving = std::count_if(falling.begin(), falling.end(), [](const btRigidBody* body) {
        return speed_of(*body) > kAtRest;
    });
    std::printf("; after 10 s %d move:", static_cast<int>(moving));
    for (const btRigidBody* body : falling) std::printf(" %.3g", speed_of(*body));
    std::printf(" m/s\n");
    return stays && fastest <= kMostSpeed;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    const auto folder = cdprep::test::shared_models("seed");
    if (!folder) {
        std::printf("skipped: no test models beside the checkout (set CDPREP_SHARED)\n");
        return 77;
    }
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"horse", "bunny"};
    bool passes = true;
    for (const std::string& name : names) {
        cdprep::Shape shape(cdprep::load(*folder / "seed" / (name + ".ply")));
        passes = cdprep::drop(name, shape) && passes;
    }
    return passes ? 0 : 1;
}
