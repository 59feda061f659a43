// SPDX-License-Identifier: MIT
// Contacts of many scans, at most 16 per pair: a random scene, where bodies overlap deeply, and a
// resting one, where neighbours in a row touch by a thousandth of their size. Contacts are the 16
// deepest, found without and with a limit of the work.
//
// Beside it, if found at configure time: FCL with the same limit, whose contacts are the first 16
// pairs of triangles that it meets; and Bullet's GImpact, as Debian builds it in float, which has
// no limit. All are asked about the same pairs: those whose boxes around the placed vertices
// overlap. Contenders take turns. Processor time, one thread.
//
// Usage: contact_scene_bench BODIES ROUNDS MODEL...
// Models are bakes with --effects contacts,collide, normalised to a diagonal of 1. Body i is of
// model i mod the number of models.
//
// Prints a CSV table; `ms` is the time of a scene, the median of the rounds, and `times` that by
// ours.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bench_input.h"
#include "cdprep/contacts.h"
#include "cdprep/pairs.h"

#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif
#ifdef CDPREP_HAVE_BULLET
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletCollision/btBulletCollisionCommon.h>

#include "bullet_transform.h"
#endif

namespace cdprep {
namespace {

constexpr std::uint32_t kMost = 16;  ///< contacts of a pair
constexpr double kSink = 0.001;      ///< by which neighbours at rest overlap
constexpr std::size_t kInRow = 10;   ///< bodies of a row at rest
constexpr double kBetweenRows = 2;   ///< more than the diagonal of a model
constexpr double kSpace = 0.55;      ///< of a random body, by the diagonal of a model

struct Body {
    std::size_t model;
    Pose pose;
    Double3 lower, upper;  ///< of the placed vertices
};

using BodyPair = std::pair<std::size_t, std::size_t>;

struct Scene {
    std::string name;
    std::vector<Body> bodies;
    std::vector<BodyPair> candidates;
};

struct Found {
    std::size_t pairs = 0;  ///< with a contact
    std::size_t contacts = 0;
};

class Contender {
public:
    virtual ~Contender() = default;
    [[nodiscard]] virtual const char* name() const = 0;
    /// Returns the number of contacts of two bodies.
    virtual std::size_t ask(const Body& a, const Body& b) = 0;
};

class Ours final : public Contender {
public:
    /// `work` is ContactOptions::work.
    Ours(const char* name, const std::vector<Model>& models, std::uint64_t work)
        : name_(name), models_(models), work_(work) {}
    [[nodiscard]] const char* name() const override {
        return name_;
    }
    std::size_t ask(const Body& a, const Body& b) override {
        const Placement placement = Placement::b_moves(relative_pose(a.pose, b.pose));
        return contacts({models_[a.model], models_[b.model], placement}, workspace_, room_,
                        {.most = kMost, .work = work_})
            .count;
    }

private:
    const char* name_;
    const std::vector<Model>& models_;
    std::uint64_t work_;
    Workspace workspace_;
    std::array<Contact, kMost> room_{};
};

#ifdef CDPREP_HAVE_FCL
class Fcl final : public Contender {
public:
    explicit Fcl(const std::vector<Model>& models) {
        for (const Model& model : models) models_.push_back(fcl_model<fcl::OBBd>(model));
    }
    [[nodiscard]] const char* name() const override {
        return "fcl_16";
    }
    std::size_t ask(const Body& a, const Body& b) override {
        fcl::CollisionResultd result;
        fcl::collide(&models_[a.model], fcl_transform(a.pose), &models_[b.model],
                     fcl_transform(b.pose), fcl::CollisionRequestd(kMost, true), result);
        return result.numContacts();
    }

private:
    std::vector<fcl::BVHModel<fcl::OBBd>> models_;
};
#endif

#ifdef CDPREP_HAVE_BULLET
class GImpact final : public Contender {
public:
    explicit GImpact(const std::vector<Model>& models) : dispatcher_(&configuration_) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
        for (const Model& model : models) add(model);
    }
    [[nodiscard]] const char* name() const override {
        return "bullet_gimpact";
    }
    std::size_t ask(const Body& a, const Body& b) override {
        place(a_, a);
        place(b_, b);
        const btCollisionObjectWrapper of_a(nullptr, a_.getCollisionShape(), &a_,
                                            a_.getWorldTransform(), -1, -1);
        const btCollisionObjectWrapper of_b(nullptr, b_.getCollisionShape(), &b_,
                                            b_.getWorldTransform(), -1, -1);
        // GImpact does not register for contactPairTest(), which asks for nearest points.
        btCollisionAlgorithm* const algorithm =
            dispatcher_.findAlgorithm(&of_a, &of_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
        Count count(&of_a, &of_b);
        algorithm->processCollision(&of_a, &of_b, btDispatcherInfo(), &count);
        algorithm->~btCollisionAlgorithm();
        dispatcher_.freeCollisionAlgorithm(algorithm);
        return count.found;
    }

private:
    struct Count final : btManifoldResult {
        using btManifoldResult::btManifoldResult;
        std::size_t found = 0;
        void addContactPoint(const btVector3& /*normal*/, const btVector3& /*point*/,
                             btScalar /*depth*/) override {
            ++found;
        }
    };
    struct Mesh {
        std::vector<btScalar> points;
        std::vector<int> corners;
        std::unique_ptr<btTriangleIndexVertexArray> arrays;
        std::unique_ptr<btGImpactMeshShape> shape;
    };

    void add(const Model& model) {
        Mesh mesh;
        const auto put = [&](double x, double y, double z) {
            for (const double c : {x, y, z}) mesh.points.push_back(static_cast<btScalar>(c));
        };
        for (const format::Float3& p : model.mesh().positions_f32) put(p.x, p.y, p.z);
        for (const format::Double3& p : model.mesh().positions_f64) put(p.x, p.y, p.z);
        for (const format::Triangle& t : model.mesh().triangles) {
            for (const std::uint32_t v : t.vertex) mesh.corners.push_back(static_cast<int>(v));
        }
        mesh.arrays = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(mesh.corners.size() / 3), mesh.corners.data(),
            static_cast<int>(3 * sizeof(int)), static_cast<int>(mesh.points.size() / 3),
            mesh.points.data(), static_cast<int>(3 * sizeof(btScalar)));
        mesh.shape = std::make_unique<btGImpactMeshShape>(mesh.arrays.get());
        mesh.shape->setMargin(0);
        mesh.shape->updateBound();
        meshes_.push_back(std::move(mesh));
    }
    void place(btCollisionObject& object, const Body& body) {
        object.setCollisionShape(meshes_[body.model].shape.get());
        object.setWorldTransform(bullet_transform(body.pose));
    }

    std::vector<Mesh> meshes_;
    btCollisionObject a_, b_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
};
#endif

Body placed(const std::vector<Model>& models, std::size_t model, const Pose& pose) {
    constexpr double kFar = 1e300;
    Body body = {model, pose, {kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    const auto take = [&](double x, double y, double z) {
        const Double3 p = transform_point(pose, {x, y, z});
        body.lower = {std::min(body.lower.x, p.x), std::min(body.lower.y, p.y),
                      std::min(body.lower.z, p.z)};
        body.upper = {std::max(body.upper.x, p.x), std::max(body.upper.y, p.y),
                      std::max(body.upper.z, p.z)};
    };
    for (const format::Float3& p : models[model].mesh().positions_f32) take(p.x, p.y, p.z);
    for (const format::Double3& p : models[model].mesh().positions_f64) take(p.x, p.y, p.z);
    return body;
}

Pose turned(std::mt19937& random, const Double3& at) {
    std::normal_distribution<double> normal;
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    return Pose::from_quaternion(w, x, y, z, at).value();
}

Pose moved(const Pose& pose, double x) {
    const auto& r = pose.rotation();
    const Double3& t = pose.translation();
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], x, t.y, t.z})
        .value();
}

void find_candidates(Scene& scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        for (std::size_t j = i + 1; j < scene.bodies.size(); ++j) {
            const Body &a = scene.bodies[i], &b = scene.bodies[j];
            const bool meet = a.lower.x <= b.upper.x && b.lower.x <= a.upper.x &&
                              a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
                              a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
            if (meet) scene.candidates.emplace_back(i, j);
        }
    }
}

Scene random_scene(const std::vector<Model>& models, std::size_t bodies) {
    Scene scene = {"random", {}, {}};
    std::mt19937 random(1);
    const double side = kSpace * std::cbrt(static_cast<double>(bodies));
    std::uniform_real_distribution<double> within(0, side);
    for (std::size_t i = 0; i < bodies; ++i) {
        const Double3 at = {within(random), within(random), within(random)};
        scene.bodies.push_back(placed(models, i % models.size(), turned(random, at)));
    }
    find_candidates(scene);
    return scene;
}

/// Bodies in rows along x: each is moved towards the one before until they touch, and sinks in.
Scene resting_scene(const std::vector<Model>& models, std::size_t bodies) {
    Scene scene = {"resting", {}, {}};
    std::mt19937 random(2);
    Workspace workspace;
    for (std::size_t i = 0; i < bodies; ++i) {
        const std::size_t row = i / kInRow;
        Pose pose = turned(random, {0, kBetweenRows * static_cast<double>(row % kInRow),
                                    kBetweenRows * static_cast<double>(row / kInRow)});
        const std::size_t model = i % models.size();
        if (i % kInRow > 0) {
            const Body& last = scene.bodies.back();
            double apart = last.pose.translation().x + 2, inside = last.pose.translation().x;
            for (int step = 0; step < 40; ++step) {
                const double middle = (apart + inside) / 2;
                const Placement placement =
                    Placement::b_moves(relative_pose(last.pose, moved(pose, middle)));
                const bool touch =
                    collide({models[last.model], models[model], placement}, workspace).hit ==
                    Answer::yes;
                (touch ? inside : apart) = middle;
            }
            pose = moved(pose, inside - kSink);
        }
        scene.bodies.push_back(placed(models, model, pose));
    }
    find_candidates(scene);
    return scene;
}

void compare(const Scene& scene, const std::vector<std::unique_ptr<Contender>>& contenders,
             int rounds) {
    std::vector<std::vector<double>> ms(contenders.size());
    std::vector<Found> found(contenders.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            found[c] = {};
            const double begun = thread_us();
            for (const auto& [a, b] : scene.candidates) {
                const std::size_t count = contenders[c]->ask(scene.bodies[a], scene.bodies[b]);
                found[c].pairs += count > 0 ? 1 : 0;
                found[c].contacts += count;
            }
            ms[c].push_back((thread_us() - begun) / 1000);
        }
    }
    for (std::size_t c = 0; c < contenders.size(); ++c) {
        std::printf("%s,%s,%zu,%zu,%zu,%zu,%.1f,%.2f\n", scene.name.c_str(), contenders[c]->name(),
                    scene.bodies.size(), scene.candidates.size(), found[c].pairs, found[c].contacts,
                    median(ms[c]), median(ms[c]) / median(ms[0]));
    }
    std::fflush(stdout);
}

void run(std::size_t bodies, int rounds, const std::vector<std::string>& paths) {
    std::vector<Model> models;
    for (const std::string& path : paths) models.push_back(open_or_stop(path));
    std::vector<std::unique_ptr<Contender>> contenders;
    contenders.push_back(std::make_unique<Ours>("cdprep_16", models, 0));
    contenders.push_back(
        std::make_unique<Ours>("cdprep_16_limited", models, 2 * kMost * kWorkOfContact));
#ifdef CDPREP_HAVE_FCL
    contenders.push_back(std::make_unique<Fcl>(models));
#endif
#ifdef CDPREP_HAVE_BULLET
    contenders.push_back(std::make_unique<GImpact>(models));
#endif
    std::printf("scene,contender,bodies,candidates,touching,contacts,ms,times\n");
    compare(random_scene(models, bodies), contenders, rounds);
    compare(resting_scene(models, bodies), contenders, rounds);
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 4) cdprep::stop("Usage: contact_scene_bench BODIES ROUNDS MODEL...");
    cdprep::run(std::strtoull(arguments[1], nullptr, 10), std::max(1, std::atoi(arguments[2])),
                {arguments + 3, arguments + count});
}
