// SPDX-License-Identifier: MIT
// What Bullet takes with a mapped file as its shape (samples/engines/bullet_shape.h), beside its
// btBvhTriangleMeshShape and GImpact: to load, and a step. A bolt of radius 6, of two convex hulls,
// falls into a hole of radius 7 of a bracket, and hangs there by its head. The triangles of the
// bracket are divided into four, again and again. Processor time, one thread, contenders in turn.
//
// Loading: ours maps the file, checks it, and makes its table. The others build from arrays that
// are in memory already, so they do not read a file.
//
// Usage: bullet_shape_bench BRACKET.cdp.h5 FOLDER [LEVELS [ROUNDS]]
// The first is samples/meshes/bracket.obj, baked. The divided models are written into FOLDER.
//
// Prints a CSV table: microseconds to load, medians of rounds; microseconds of a step while the
// bolt falls (0.1 s) and while it hangs (0.4 s), medians over steps and rounds, and the 95th
// percentile; the spread of the middle half; and where the head is above the plate at the end.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bench_input.h"
#include "bullet_shape.h"
#include "cdprep/build.h"

namespace cdprep {
namespace {

constexpr btScalar kMargin = btScalar(0.1);
constexpr btScalar kStep = btScalar(1) / 480;
constexpr int kFalling = 48;  ///< steps
constexpr int kSteps = 240;
constexpr double kPlate = 6, kNeck = 26;

struct Mesh {
    std::vector<Float3> positions;
    std::vector<format::Triangle> triangles;
};

Mesh mesh_of(const Model& model) {
    const auto positions = model.mesh().positions_f32;
    const auto triangles = model.mesh().triangles;
    if (positions.empty() || triangles.empty()) stop("the bracket has no floats: bake it again");
    return {{positions.begin(), positions.end()}, {triangles.begin(), triangles.end()}};
}

/// The same surface, with four triangles for each.
Mesh divided(const Mesh& mesh) {
    Mesh made = {mesh.positions, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, is_new] = middles.try_emplace(
            std::minmax(a, b), static_cast<std::uint32_t>(made.positions.size()));
        if (is_new) {
            const Float3 p = made.positions[a], q = made.positions[b];
            made.positions.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
        }
        return at->second;
    };
    for (const auto& [v] : mesh.triangles) {
        const std::uint32_t c = middle(v[0], v[1]), a = middle(v[1], v[2]), b = middle(v[2], v[0]);
        for (const auto& t : {format::Triangle{{v[0], c, b}}, format::Triangle{{c, v[1], a}},
                              format::Triangle{{b, a, v[2]}}, format::Triangle{{a, b, c}}}) {
            made.triangles.push_back(t);
        }
    }
    return made;
}

void write_model(const Mesh& mesh, const std::filesystem::path& path) {
    const auto arrays = build::build_model(mesh.positions, mesh.triangles);
    if (!arrays) stop(arrays.error().message);
    const auto list = arrays.value().sections(sections_for(Ask::touch | Ask::corners));
    const auto size = build::image_size(list.sections());
    if (!size) stop(size.error().message);
    std::vector<std::byte> room(size.value() + format::kPageAlignment);
    void* place = room.data();
    std::size_t space = room.size();
    std::align(format::kPageAlignment, size.value(), place, space);
    const auto image = build::build_image(arrays.value().facts, list.sections(),
                                          {static_cast<std::byte*>(place), size.value()});
    if (!image) stop(image.error().message);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.value().data()),
               static_cast<std::streamsize>(image.value().size()));
}

/// A shape with what it points to.
struct Loaded {
    std::shared_ptr<void> kept;
    btCollisionShape* shape;
};

Loaded load_ours(const std::filesystem::path& path, Workspace& workspace) {
    struct Kept {
        Model model;
        BulletShape shape;
        Kept(Model&& opened, Workspace& space)
            : model(std::move(opened)), shape(model, space, kMargin) {}
    };
    auto opened = Model::open(path, Ask::touch | Ask::corners);
    if (!opened) stop(opened.error().message);
    auto kept = std::make_shared<Kept>(std::move(opened).value(), workspace);
    return {kept, &kept->shape};
}

/// Arrays as Bullet reads them.
struct Arrays {
    std::vector<btScalar> points;
    std::vector<int> corners;
    btTriangleIndexVertexArray array;

    explicit Arrays(const Mesh& mesh) {
        for (const Float3& p : mesh.positions) points.insert(points.end(), {p.x, p.y, p.z});
        for (const format::Triangle& t : mesh.triangles) {
            for (const std::uint32_t v : t.vertex) corners.push_back(static_cast<int>(v));
        }
        btIndexedMesh part;
        part.m_numTriangles = static_cast<int>(mesh.triangles.size());
        part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(corners.data());
        part.m_triangleIndexStride = 3 * sizeof(int);
        part.m_numVertices = static_cast<int>(mesh.positions.size());
        part.m_vertexBase = reinterpret_cast<const unsigned char*>(points.data());
        part.m_vertexStride = 3 * sizeof(btScalar);
        array.addIndexedMesh(part);
    }
};

Loaded load_bvh(Arrays& arrays) {
    auto shape = std::make_shared<btBvhTriangleMeshShape>(&arrays.array, true);
    shape->setMargin(kMargin);
    return {shape, shape.get()};
}

Loaded load_gimpact(Arrays& arrays) {
    auto shape = std::make_shared<btGImpactMeshShape>(&arrays.array);
    shape->setMargin(kMargin);
    shape->updateBound();
    return {shape, shape.get()};
}

/// The points of a prism about the z axis.
std::unique_ptr<btConvexHullShape> prism(double radius, int count, double low, double high) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < 2 * count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        hull->addPoint({btScalar(radius * std::cos(angle)), btScalar(radius * std::sin(angle)),
                        btScalar(i < count ? low : high)},
                       false);
    }
    hull->setMargin(kMargin);
    hull->recalcLocalAabb();
    return hull;
}

/// The bolt of samples/meshes as two hulls, about its centre of mass.
struct Bolt {
    static constexpr btScalar kCentre = btScalar(20.05);
    std::unique_ptr<btConvexHullShape> shank = prism(6, 48, 0, kNeck);
    std::unique_ptr<btConvexHullShape> head = prism(10, 6, kNeck, 34);
    btCompoundShape shape;

    Bolt() {
        const btTransform down(btQuaternion::getIdentity(), {0, 0, -kCentre});
        shape.addChildShape(down, shank.get());
        shape.addChildShape(down, head.get());
    }
};

struct Times {
    std::vector<double> load, falling, hanging;  ///< microseconds
    double height = 0;
};

/// Lets the bolt fall, and times each step.
void drop(btCollisionShape& bracket, Times& times) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    world.setGravity({0, 0, -9810});
    Bolt bolt;
    btVector3 inertia;
    bolt.shape.calculateLocalInertia(5, inertia);
    btRigidBody standing(0, nullptr, &bracket), falling(5, nullptr, &bolt.shape, inertia);
    falling.setCenterOfMassTransform(
        btTransform(btQuaternion::getIdentity(),
                    {btScalar(23.3), btScalar(14.8), btScalar(kPlate + 10) + Bolt::kCentre}));
    falling.setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(&standing);
    world.addRigidBody(&falling);
    for (int i = 0; i < kSteps; ++i) {
        const double begun = thread_us();
        world.stepSimulation(kStep, 0);
        (i < kFalling ? times.falling : times.hanging).push_back(thread_us() - begun);
    }
    const btVector3 neck =
        falling.getCenterOfMassTransform() * btVector3(0, 0, btScalar(kNeck) - Bolt::kCentre);
    times.height = double{neck.z()} - kPlate;
    world.removeRigidBody(&falling);
    world.removeRigidBody(&standing);
}

void compare(const Mesh& mesh, const std::filesystem::path& path, int rounds) {
    Workspace workspace;
    Arrays arrays(mesh);
    const std::array<std::pair<const char*, std::function<Loaded()>>, 3> contenders = {
        {{"mapped file", [&] { return load_ours(path, workspace); }},
         {"btBvhTriangleMeshShape", [&] { return load_bvh(arrays); }},
         {"GImpact", [&] { return load_gimpact(arrays); }}}};
    std::array<Times, contenders.size()> times;
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            const double begun = thread_us();
            const Loaded loaded = contenders[c].second();
            times[c].load.push_back(thread_us() - begun);
            drop(*loaded.shape, times[c]);
        }
    }
    for (std::size_t c = 0; c < contenders.size(); ++c) {
        const Times& t = times[c];
        std::printf("%zu,%s,%.1f,%.1f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.3f\n", mesh.triangles.size(),
                    contenders[c].first, median(t.load), spread(t.load), median(t.falling),
                    median(t.falling, 0.95), spread(t.falling), median(t.hanging),
                    median(t.hanging, 0.95), spread(t.hanging), t.height);
    }
    std::fflush(stdout);
}

void run(const Model& bracket, const std::filesystem::path& folder, int levels, int rounds) {
    std::printf(
        "triangles,shape,load_us,load_spread,falling_us,falling_p95,falling_spread,hanging_us,"
        "hanging_p95,hanging_spread,head_above_plate\n");
    Mesh mesh = mesh_of(bracket);
    for (int level = 0; level < levels; ++level) {
        if (level > 0) mesh = divided(mesh);
        const auto path = folder / ("bracket_" + std::to_string(level) + ".image");
        write_model(mesh, path);
        compare(mesh, path, rounds);
    }
}

}  // namespace
}  // namespace cdprep

int main(int argc, char** argv) {
    if (argc < 3) {
        cdprep::stop("usage: bullet_shape_bench BRACKET.cdp.h5 FOLDER [LEVELS [ROUNDS]]");
    }
    const int levels = argc > 3 ? std::atoi(argv[3]) : 6;
    const int rounds = argc > 4 ? std::max(std::atoi(argv[4]), 1) : 5;
    cdprep::run(cdprep::open_or_stop(argv[1]), argv[2], levels, rounds);
    return 0;
}
