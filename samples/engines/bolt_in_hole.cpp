// SPDX-License-Identifier: MIT
// A bolt of radius 6 falls into a hole of radius 7 of a bracket, in Bullet. Where does it stay?
//
//     cdprep bake bracket.obj bolt.obj --effects touch,corners,contacts,response
//       --structures hull --max-error 0.5
//     sample_bolt_in_hole bracket.cdp.h5 bolt.cdp.h5
//
// Lengths are millimetres. The exact bracket lets the bolt in, and its head stops it. This holds
// for the hulls of the bolt's parts, and for its exact surface. Hulls of the bracket's parts narrow
// the hole: off its axis, the bolt does not enter. The hull of the whole bracket has no hole.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "bullet_shape.h"
#include "cdprep/hulls.h"

namespace {

constexpr btScalar kMargin = btScalar(0.1);     // of hulls, and of the triangles that they meet
constexpr btScalar kTolerance = btScalar(0.5);  // of contacts; see BulletContacts
constexpr btScalar kStep = btScalar(1) / 1920;  // seconds: the bolt falls at most 0.8 m/s
constexpr int kSteps = 1920;
constexpr double kPlate = 6, kNeck = 26;  // z of the bracket's plate, and of the bolt's head
constexpr double kHoleX = 23, kHoleY = 15;

struct Start {
    double x, y, turn;  // millimetres from the hole's axis; radians about it
};

btVector3 bullet_vector(const cdprep::Double3& p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

btTransform moved_by(const btVector3& way) {
    return btTransform(btQuaternion::getIdentity(), way);
}

/// A compound shape with its parts. Bullet turns a body about its origin, so that must be the
/// centre of mass.
struct Parts {
    btCompoundShape shape;
    std::vector<std::unique_ptr<btCollisionShape>> parts;

    void add(std::unique_ptr<btCollisionShape> part, const btVector3& centre) {
        shape.addChildShape(moved_by(-centre), part.get());
        parts.push_back(std::move(part));
    }
    /// Adds the hulls that the file has of the scope.
    void add_hulls(const cdprep::Model& model, cdprep::format::HullScope scope,
                   const btVector3& centre) {
        for (std::uint32_t number = 0; const auto found = find_hull(model, scope, number);
             ++number) {
            const cdprep::ConvexPoints points = convex_points(model, *found);
            auto hull = std::make_unique<btConvexHullShape>();
            for (std::uint32_t i = 0; i < points.count; ++i) {
                hull->addPoint(bullet_vector(points.point(i)), false);
            }
            hull->setMargin(kMargin);
            hull->recalcLocalAabb();
            add(std::move(hull), centre);
        }
    }
};

/// Bullet's world with a bracket that stands and a bolt that falls.
class World {
public:
    World(btCollisionShape& bracket, btCollisionShape& bolt, const cdprep::Model& model,
          const Start& start, cdprep::Workspace& workspace)
        : contacts_(workspace, double{kTolerance}),
          dispatcher_(&configuration_),
          centre_(bullet_vector(model.record().mass->centre)),
          bracket_(0, nullptr, &bracket),
          bolt_(btScalar(model.record().mass->volume), nullptr, &bolt, inertia_of(model)) {
        dispatcher_.registerCollisionCreateFunc(FAST_CONCAVE_MESH_PROXYTYPE,
                                                FAST_CONCAVE_MESH_PROXYTYPE, &contacts_);
        world_.setGravity({0, 0, -9810});
        const btQuaternion turn({0, 0, 1}, btScalar(start.turn));
        const btVector3 place(btScalar(kHoleX + start.x), btScalar(kHoleY + start.y),
                              btScalar(kPlate + 5));
        bolt_.setCenterOfMassTransform(btTransform(turn, place + quatRotate(turn, centre_)));
        bolt_.setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(&bracket_);
        world_.addRigidBody(&bolt_);
    }
    ~World() {
        world_.removeRigidBody(&bolt_);
        world_.removeRigidBody(&bracket_);
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    void step() {
        world_.stepSimulation(kStep, 0);
    }
    /// Where a point of the bolt is.
    [[nodiscard]] btVector3 place_of(const btVector3& point) const {
        return bolt_.getCenterOfMassTransform() * (point - centre_);
    }

private:
    /// The axes of the bolt are its principal ones. The density is 1.
    static btVector3 inertia_of(const cdprep::Model& model) {
        const auto& inertia = model.record().mass->inertia;
        return {btScalar(inertia[0]), btScalar(inertia[1]), btScalar(inertia[2])};
    }

    BulletContacts contacts_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    btVector3 centre_;
    btRigidBody bracket_, bolt_;
};

void drop(const char* what, btCollisionShape& bracket, btCollisionShape& bolt,
          const cdprep::Model& model, cdprep::Workspace& workspace) {
    for (const Start& start : {Start{0, 0, 0}, Start{0.6, -0.5, 0.4}}) {
        World world(bracket, bolt, model, start, workspace);
        for (int i = 0; i < kSteps; ++i) world.step();
        const btVector3 neck = world.place_of({0, 0, btScalar(kNeck)});
        const double height = double{neck.z()} - kPlate;
        const double aside = std::hypot(double{neck.x()} - kHoleX, double{neck.y()} - kHoleY);
        const bool is_in_hole = aside < 1 && std::abs(height) < 1;
        std::printf("%s: the bolt %s; its head is %.2f mm above the plate, %.2f mm aside\n", what,
                    is_in_hole ? "hangs by its head" : "is not in the hole", height, aside);
    }
}

cdprep::Result<cdprep::Model> open_model(const char* path) {
    using cdprep::Ask;
    return cdprep::Model::open(
        path, Ask::touch | Ask::corners | Ask::contacts | Ask::response | Ask::hulls);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: sample_bolt_in_hole BRACKET BOLT\n");
        return 2;
    }
    const auto bracket = open_model(argv[1]), bolt = open_model(argv[2]);
    if (!bracket || !bolt) {
        std::fprintf(stderr, "%s\n", (bracket ? bolt : bracket).error().message.c_str());
        return 3;
    }
    using cdprep::format::HullScope;
    cdprep::Workspace workspace;
    const btVector3 centre = bullet_vector(bolt.value().record().mass->centre);
    Parts bolt_hulls, bracket_hulls, bracket_hull, exact_bolt;
    bolt_hulls.add_hulls(bolt.value(), HullScope::part, centre);
    bracket_hulls.add_hulls(bracket.value(), HullScope::part, {0, 0, 0});
    bracket_hull.add_hulls(bracket.value(), HullScope::whole, {0, 0, 0});
    BulletShape exact_bracket(bracket.value(), workspace, kMargin);
    drop("exact bracket, hulls of the bolt", exact_bracket, bolt_hulls.shape, bolt.value(),
         workspace);
    exact_bracket.setMargin(kTolerance / 2);
    exact_bolt.add(std::make_unique<BulletShape>(bolt.value(), workspace, kTolerance / 2), centre);
    drop("exact bracket, exact bolt", exact_bracket, exact_bolt.shape, bolt.value(), workspace);
    drop("hulls of the bracket's parts", bracket_hulls.shape, bolt_hulls.shape, bolt.value(),
         workspace);
    drop("hull of the whole bracket", bracket_hull.shape, bolt_hulls.shape, bolt.value(),
         workspace);
    return 0;
}
