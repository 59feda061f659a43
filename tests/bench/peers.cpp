// SPDX-License-Identifier: MIT
// Other libraries answer about the same two models at the same poses, for `cdprep compare
// --peers`: FCL, ODE (OPCODE), Bullet (GImpact) and CGAL, as far as each was found when this
// was built. Not part of the product, and linked into nothing of it.
//
// Usage: peers A B QUESTIONS TOLERANCE ROUNDS SECONDS
// A and B are baked models. A line of QUESTIONS is letters and 12 numbers: what is asked at that
// pose (c collide, o overlap, d distance, w within TOLERANCE), then R row by row and T, a point
// b of B being at R b + T in A's frame. Every question is asked ROUNDS times, or as often as
// SECONDS allow for one question of one peer, once at least. One thread, processor time.
//
// Prints JSON: {"peers": [{"name", "note", "build_s", "collide": {"seconds": [one a pose that
// was asked], "answers": [...]}, ..., "reasons": {"overlap": why it was not asked}}],
// "absent": [{"name", "reason"}]}. Answers: 0 or 1; of overlap, the number of pairs.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bench_input.h"

#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif
#ifdef CDPREP_HAVE_ODE
#include <ode/ode.h>
#endif
#ifdef CDPREP_HAVE_BULLET
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#endif
#ifdef CDPREP_HAVE_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>
#endif

namespace cdprep {
namespace {

constexpr std::size_t kMostPairs = 1U << 22;
constexpr std::array<char, 4> kLetters = {'c', 'o', 'd', 'w'};
constexpr std::array<const char*, 4> kNames = {"collide", "overlap", "distance", "within"};

double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// A pose, and what is asked at it.
struct Case {
    std::string letters;
    Pose a_from_b;
};

std::vector<Case> read_cases(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::vector<Case> cases;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        Case made;
        std::array<double, 12> rows{};
        words >> made.letters;
        for (double& number : rows) words >> number;
        auto pose = Pose::from_rows(rows);
        if (!words || !pose) stop(path.string() + ": a line is no pose.");
        made.a_from_b = pose.value();
        cases.push_back(std::move(made));
    }
    if (cases.empty()) stop(path.string() + " holds no pose.");
    return cases;
}

/// Corners and triangles as libraries take them.
struct Mesh {
    explicit Mesh(const Model& model) {
        for (const Float3& p : model.positions_f32()) points.push_back({p.x, p.y, p.z});
        for (const Double3& p : model.positions_f64()) points.push_back(p);
        for (const format::Triangle& t : model.triangles()) triangles.push_back(t.vertex);
    }

    std::vector<Double3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

class Peer {
public:
    Peer() = default;
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    virtual ~Peer() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual std::string note() const = 0;
    /// Why it cannot be asked that; empty when it can.
    [[nodiscard]] virtual std::string find_reason(char letter) const = 0;
    virtual std::size_t ask(char letter, const Pose& a_from_b) = 0;
};

#ifdef CDPREP_HAVE_FCL
class Fcl final : public Peer {
public:
    Fcl(const Model& a, const Model& b, double tolerance)
        : a_(fcl_model<fcl::OBBd>(a)),
          b_(fcl_model<fcl::OBBd>(b)),
          spheres_a_(fcl_model<fcl::RSSd>(a)),
          spheres_b_(fcl_model<fcl::RSSd>(b)),
          tolerance_(tolerance) {}
    [[nodiscard]] std::string name() const override {
        return "FCL " FCL_VERSION;
    }
    [[nodiscard]] std::string note() const override {
        return "oriented boxes for collide and overlap, swept rectangles for distance, as PQP, of "
               "which it descends; it has no tolerance question: its distance answers that";
    }
    [[nodiscard]] std::string find_reason(char /*letter*/) const override {
        return "";
    }
    std::size_t ask(char letter, const Pose& a_from_b) override {
        const fcl::Transform3d placed = fcl_transform(a_from_b);
        if (letter == 'c' || letter == 'o') {
            fcl::CollisionResultd result;
            fcl::collide(&a_, fcl::Transform3d::Identity(), &b_, placed,
                         fcl::CollisionRequestd(letter == 'o' ? kMostPairs : 1, false), result);
            return result.numContacts();
        }
        fcl::DistanceResultd result;
        fcl::distance(&spheres_a_, fcl::Transform3d::Identity(), &spheres_b_, placed,
                      fcl::DistanceRequestd(false, false, 0, 0), result);
        if (letter == 'd') return result.min_distance > 0 ? 1 : 0;
        return result.min_distance <= tolerance_ ? 1 : 0;
    }

private:
    fcl::BVHModel<fcl::OBBd> a_;
    fcl::BVHModel<fcl::OBBd> b_;
    fcl::BVHModel<fcl::RSSd> spheres_a_;
    fcl::BVHModel<fcl::RSSd> spheres_b_;
    double tolerance_;
};
#endif

#ifdef CDPREP_HAVE_ODE
class Ode final : public Peer {
public:
    Ode(const Model& a, const Model& b) : a_(a), b_(b) {}
    [[nodiscard]] std::string name() const override {
        return "ODE 0.16 (OPCODE)";
    }
    [[nodiscard]] std::string note() const override {
        return sizeof(dReal) == 8 ? "double" : "single precision";
    }
    [[nodiscard]] std::string find_reason(char letter) const override {
        if (letter == 'c') return "";
        return letter == 'o' ? "gives contacts, not pairs of triangles"
                             : "has no distances of meshes";
    }
    std::size_t ask(char /*letter*/, const Pose& a_from_b) override {
        const auto& r = a_from_b.rotation();
        const Double3& t = a_from_b.translation();
        const auto real = [](double x) { return static_cast<dReal>(x); };
        const dMatrix3 rotation = {real(r[0]), real(r[1]), real(r[2]), 0,
                                   real(r[3]), real(r[4]), real(r[5]), 0,
                                   real(r[6]), real(r[7]), real(r[8]), 0};
        dGeomSetRotation(b_.geom, rotation);
        dGeomSetPosition(b_.geom, real(t.x), real(t.y), real(t.z));
        dContactGeom contact;
        return dCollide(a_.geom, b_.geom, 1, &contact, sizeof contact) > 0 ? 1 : 0;
    }

    struct Library {
        Library() {
            dInitODE2(0);
        }
        ~Library() {
            dCloseODE();
        }
        Library(const Library&) = delete;
        Library& operator=(const Library&) = delete;
    };

private:
    struct Body {
        explicit Body(const Model& model) {
            const Mesh mesh(model);
            for (const Double3& p : mesh.points) {
                points.insert(points.end(), {static_cast<float>(p.x), static_cast<float>(p.y),
                                             static_cast<float>(p.z)});
            }
            for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
            data = dGeomTriMeshDataCreate();
            dGeomTriMeshDataBuildSingle(data, points.data(), 3 * sizeof(float),
                                        static_cast<int>(mesh.points.size()), indices.data(),
                                        static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
            geom = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
        }
        ~Body() {
            dGeomDestroy(geom);
            dGeomTriMeshDataDestroy(data);
        }
        Body(const Body&) = delete;
        Body& operator=(const Body&) = delete;

        std::vector<float> points;
        std::vector<dTriIndex> indices;
        dTriMeshDataID data = nullptr;
        dGeomID geom = nullptr;
    };

    Library library_;
    Body a_;
    Body b_;
};
#endif

#ifdef CDPREP_HAVE_BULLET
class Bullet final : public Peer {
public:
    Bullet(const Model& a, const Model& b) : a_(a), b_(b) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
        // For a question about one pair Bullet looks in another table, which that leaves empty.
        dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE,
                                                    GIMPACT_SHAPE_PROXYTYPE, &create_);
        world_.addCollisionObject(&a_.object);
        world_.addCollisionObject(&b_.object);
    }
    ~Bullet() override {
        world_.removeCollisionObject(&a_.object);
        world_.removeCollisionObject(&b_.object);
    }
    [[nodiscard]] std::string name() const override {
        return "Bullet " + std::to_string(BT_BULLET_VERSION) + " (GImpact)";
    }
    [[nodiscard]] std::string note() const override {
        return "single precision, as its package is built; margin 0";
    }
    [[nodiscard]] std::string find_reason(char letter) const override {
        return letter == 'c' || letter == 'o' ? "" : "has no distances of meshes";
    }
    std::size_t ask(char letter, const Pose& a_from_b) override {
        const auto& r = a_from_b.rotation();
        const Double3& t = a_from_b.translation();
        const auto real = [](double x) { return static_cast<btScalar>(x); };
        const btMatrix3x3 rotation(real(r[0]), real(r[1]), real(r[2]), real(r[3]), real(r[4]),
                                   real(r[5]), real(r[6]), real(r[7]), real(r[8]));
        b_.object.setWorldTransform(
            btTransform(rotation, btVector3(real(t.x), real(t.y), real(t.z))));
        Touching touching;
        world_.contactPairTest(&a_.object, &b_.object, touching);
        return letter == 'c' ? std::min<std::size_t>(1, touching.pairs.size())
                             : touching.pairs.size();
    }

private:
    struct Body {
        explicit Body(const Model& model) {
            const Mesh mesh(model);
            for (const Double3& p : mesh.points) {
                points.insert(points.end(), {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y),
                                             static_cast<btScalar>(p.z)});
            }
            for (const auto& t : mesh.triangles) {
                for (const std::uint32_t v : t) indices.push_back(static_cast<int>(v));
            }
            constexpr int kIndices = 3 * sizeof(int);
            constexpr int kPoints = 3 * sizeof(btScalar);
            triangles = std::make_unique<btTriangleIndexVertexArray>(
                static_cast<int>(mesh.triangles.size()), indices.data(), kIndices,
                static_cast<int>(mesh.points.size()), points.data(), kPoints);
            shape = std::make_unique<btGImpactMeshShape>(triangles.get());
            shape->setMargin(0);
            shape->updateBound();
            object.setCollisionShape(shape.get());
        }

        std::vector<btScalar> points;
        std::vector<int> indices;
        std::unique_ptr<btTriangleIndexVertexArray> triangles;
        std::unique_ptr<btGImpactMeshShape> shape;
        btCollisionObject object;
    };

    struct Touching final : btCollisionWorld::ContactResultCallback {
        btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* /*a*/,
                                 int /*part_a*/, int index_a, const btCollisionObjectWrapper* /*b*/,
                                 int /*part_b*/, int index_b) override {
            if (point.getDistance() <= 0) pairs.insert({index_a, index_b});
            return 0;
        }
        std::set<std::pair<int, int>> pairs;
    };

    btGImpactCollisionAlgorithm::CreateFunc create_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
    Body a_;
    Body b_;
};
#endif

#ifdef CDPREP_HAVE_CGAL
class Cgal final : public Peer {
public:
    Cgal(const Model& a, const Model& b) : a_(mesh_of(a)), b_(mesh_of(b)) {
        detection_.add_mesh(a_);
        detection_.add_mesh(b_);
    }
    [[nodiscard]] std::string name() const override {
        return "CGAL " CGAL_VERSION_STR;
    }
    [[nodiscard]] std::string note() const override {
        return "Rigid_triangle_mesh_collision_detection, exact predicates";
    }
    [[nodiscard]] std::string find_reason(char letter) const override {
        if (letter == 'c') return "";
        return letter == 'o' ? "tells that meshes meet, not where" : "has no distances of meshes";
    }
    std::size_t ask(char /*letter*/, const Pose& a_from_b) override {
        const auto& r = a_from_b.rotation();
        const Double3& t = a_from_b.translation();
        detection_.set_transformation(
            1, {r[0], r[1], r[2], t.x, r[3], r[4], r[5], t.y, r[6], r[7], r[8], t.z});
        return detection_.get_all_intersections(1).size();
    }

private:
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

    /// Each triangle with corners of its own: what is not manifold is taken too.
    static Surface mesh_of(const Model& model) {
        const Mesh mesh(model);
        Surface made;
        for (const auto& t : mesh.triangles) {
            std::array<Surface::Vertex_index, 3> corner;
            for (std::size_t i = 0; i < 3; ++i) {
                const Double3& p = mesh.points[t[i]];
                corner[i] = made.add_vertex({p.x, p.y, p.z});
            }
            made.add_face(corner[0], corner[1], corner[2]);
        }
        return made;
    }

    Surface a_;
    Surface b_;
    CGAL::Rigid_triangle_mesh_collision_detection<Surface> detection_;
};
#endif

/// What a peer took and said, of the cases that ask it.
struct Answered {
    std::vector<double> seconds;
    std::vector<std::size_t> answers;
};

Answered ask_all(Peer& peer, char letter, const std::vector<Case>& cases, std::size_t rounds,
                 double budget) {
    std::vector<const Case*> asked;
    for (const Case& one : cases) {
        if (one.letters.find(letter) != std::string::npos) asked.push_back(&one);
    }
    std::vector<std::vector<double>> seconds(asked.size());
    Answered answered;
    answered.answers.resize(asked.size());
    const double begun = thread_seconds();
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round > 0 && thread_seconds() - begun > budget) break;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            const double before = thread_seconds();
            answered.answers[i] = peer.ask(letter, asked[i]->a_from_b);
            seconds[i].push_back(thread_seconds() - before);
        }
    }
    for (const auto& taken : seconds) answered.seconds.push_back(median(taken));
    return answered;
}

template <class Number>
void print_list(const char* name, const std::vector<Number>& numbers) {
    std::printf("\"%s\": [", name);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::printf("%s%.9g", i > 0 ? ", " : "", static_cast<double>(numbers[i]));
    }
    std::printf("]");
}

class Output {
public:
    template <class Make>
    void add(Make make) {
        const double before = thread_seconds();
        const std::unique_ptr<Peer> peer = make();
        const double build_s = thread_seconds() - before;
        std::printf("%s  {\"name\": \"%s\", \"note\": \"%s\", \"build_s\": %.9g", separator(),
                    peer->name().c_str(), peer->note().c_str(), build_s);
        std::string reasons;
        for (std::size_t q = 0; q < kLetters.size(); ++q) {
            const std::string reason = peer->find_reason(kLetters[q]);
            if (!reason.empty()) {
                reasons += std::string(reasons.empty() ? "" : ", ") + "\"" + kNames[q] + "\": \"" +
                           reason + "\"";
                continue;
            }
            const Answered answered = ask_all(*peer, kLetters[q], cases, rounds, budget);
            std::printf(",\n   \"%s\": {", kNames[q]);
            print_list("seconds", answered.seconds);
            std::printf(", ");
            print_list("answers", answered.answers);
            std::printf("}");
        }
        std::printf(",\n   \"reasons\": {%s}}", reasons.c_str());
        std::fflush(stdout);
    }

    std::vector<Case> cases;
    std::size_t rounds = 1;
    double budget = 1;

private:
    const char* separator() {
        return std::exchange(is_first_, false) ? "\n" : ",\n";
    }
    bool is_first_ = true;
};

int main_of(const std::vector<std::string>& arguments) {
    if (arguments.size() != 6) stop("Usage: see the head of peers.cpp.");
    const Model a = open_or_stop(arguments[0]);
    const Model b = open_or_stop(arguments[1]);
    Output output;
    output.cases = read_cases(arguments[2]);
    [[maybe_unused]] const double tolerance = std::strtod(arguments[3].c_str(), nullptr);
    output.rounds = std::max<std::size_t>(1, std::strtoul(arguments[4].c_str(), nullptr, 10));
    output.budget = std::strtod(arguments[5].c_str(), nullptr);
    std::string absent =
        "{\"name\": \"PQP\", \"reason\": \"no Debian package; its licence is for research "
        "only\"},\n"
        "  {\"name\": \"SWIFT++\", \"reason\": \"no Debian package; its licence is for research "
        "only\"}";
    [[maybe_unused]] const auto lacks = [&](const char* name) {
        absent += std::string(",\n  {\"name\": \"") + name +
                  "\", \"reason\": \"its package was not installed when peers was built\"}";
    };
    std::printf("{\"peers\": [");
#ifdef CDPREP_HAVE_FCL
    output.add([&] { return std::make_unique<Fcl>(a, b, tolerance); });
#else
    lacks("FCL");
#endif
#ifdef CDPREP_HAVE_ODE
    output.add([&] { return std::make_unique<Ode>(a, b); });
#else
    lacks("ODE");
#endif
#ifdef CDPREP_HAVE_BULLET
    output.add([&] { return std::make_unique<Bullet>(a, b); });
#else
    lacks("Bullet");
#endif
#ifdef CDPREP_HAVE_CGAL
    output.add([&] { return std::make_unique<Cgal>(a, b); });
#else
    lacks("CGAL");
#endif
    std::printf("],\n \"absent\": [%s]}\n", absent.c_str());
    return 0;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    return cdprep::main_of({arguments + 1, arguments + count});
}
