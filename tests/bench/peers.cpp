// SPDX-License-Identifier: MIT
// Other libraries answer about the same two models at the same poses, and build their structures
// over one, for `cdprep compare --peers`: FCL, ODE (OPCODE), Bullet (GImpact), CGAL, Embree and
// qhull, as far as each was found when this was built. Not part of the product, and linked into
// nothing of it.
//
// Usage: peers pair A B QUESTIONS TOLERANCE ROUNDS SECONDS
//        peers build MODEL ROUNDS SECONDS
// A, B and MODEL are baked models. A line of QUESTIONS is letters and 12 numbers: what is asked at
// that pose (c collide, o overlap, d distance, w within TOLERANCE), then R row by row and T, a
// point b of B being at R b + T in A's frame. All is done ROUNDS times, or as often as SECONDS
// allow for one question of one peer, once at least. One thread, processor time.
//
// Prints JSON. pair: {"peers": [{"key", "name", "note", "collide": {"seconds": [a pose that was
// asked: [a round, ...], ...], "answers": [...]}, ..., "reasons": {"overlap": why it was not
// asked}}], "absent": [{"key", "name", "reason"}]}. Answers: 0 or 1; of overlap, the number of
// pairs. build: {"builds": [{"key", "name", "note", "seconds": [...], "vertices", "facets"}],
// "absent"}; vertices and facets are of hulls alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
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
#ifdef CDPREP_HAVE_EMBREE
#include <embree3/rtcore.h>

#include "study/naive_contact.h"
#endif
#ifdef CDPREP_HAVE_QHULL
extern "C" {
#include <libqhull_r/qhull_ra.h>
}
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
        if (!words || !pose) stop(path.string() + ": a line is not a pose.");
        made.a_from_b = pose.value();
        cases.push_back(std::move(made));
    }
    if (cases.empty()) stop(path.string() + " contains no pose.");
    return cases;
}

/// Corners and triangles as libraries take them.
struct Mesh {
    explicit Mesh(const Model& model) {
        for (const Float3& p : model.mesh().positions_f32) points.push_back({p.x, p.y, p.z});
        for (const Double3& p : model.mesh().positions_f64) points.push_back(p);
        for (const format::Triangle& t : model.mesh().triangles) triangles.push_back(t.vertex);
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
    [[nodiscard]] virtual const char* key() const = 0;
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
    [[nodiscard]] const char* key() const override {
        return "fcl";
    }
    [[nodiscard]] std::string name() const override {
        return "FCL " FCL_VERSION;
    }
    [[nodiscard]] std::string note() const override {
        return "oriented boxes for collide and overlap, swept rectangles for distance, as in PQP, "
               "from which FCL is derived; it has no tolerance query: its distance query answers "
               "that";
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
        // Its search visits nothing beyond the distance that it has found.
        if (letter == 'w') {
            result.min_distance =
                std::nextafter(tolerance_, std::numeric_limits<double>::infinity());
        }
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
    [[nodiscard]] const char* key() const override {
        return "ode";
    }
    [[nodiscard]] std::string name() const override {
        return "ODE 0.16 (OPCODE)";
    }
    [[nodiscard]] std::string note() const override {
        return sizeof(dReal) == 8 ? "double" : "single precision";
    }
    [[nodiscard]] std::string find_reason(char letter) const override {
        if (letter == 'c') return "";
        return letter == 'o' ? "finds contacts, not pairs of triangles"
                             : "has no distance query for meshes";
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

    /// One model by itself.
    struct Alone {
        explicit Alone(const Model& model) : body(model) {}
        Library library;
        Body body;
    };

private:
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
    [[nodiscard]] const char* key() const override {
        return "bullet";
    }
    [[nodiscard]] std::string name() const override {
        return "Bullet " + std::to_string(BT_BULLET_VERSION) + " (GImpact)";
    }
    [[nodiscard]] std::string note() const override {
        return "single precision, like its package; margin 0";
    }
    [[nodiscard]] std::string find_reason(char letter) const override {
        return letter == 'c' || letter == 'o' ? "" : "has no distance query for meshes";
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

private:
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
    [[nodiscard]] const char* key() const override {
        return "cgal";
    }
    [[nodiscard]] std::string name() const override {
        return "CGAL " CGAL_VERSION_STR;
    }
    [[nodiscard]] std::string note() const override {
        return "Rigid_triangle_mesh_collision_detection, exact predicates";
    }
    [[nodiscard]] std::string find_reason(char letter) const override {
        if (letter == 'c') return "";
        return letter == 'o' ? "tests whether meshes collide, but lists no triangles"
                             : "has no distance query for meshes";
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

public:
    /// One model by itself.
    struct Alone {
        explicit Alone(const Model& model) : surface(mesh_of(model)) {
            detection.add_mesh(surface);
        }
        Surface surface;
        CGAL::Rigid_triangle_mesh_collision_detection<Surface> detection;
    };

private:
    Surface a_;
    Surface b_;
    CGAL::Rigid_triangle_mesh_collision_detection<Surface> detection_;
};
#endif

#ifdef CDPREP_HAVE_EMBREE
/// A device that takes no other threads.
class EmbreeDevice {
public:
    EmbreeDevice() : device_(rtcNewDevice("threads=1")) {
        if (device_ == nullptr) stop("Embree has no device.");
    }
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;
    ~EmbreeDevice() {
        rtcReleaseDevice(device_);
    }
    [[nodiscard]] RTCDevice get() const {
        return device_;
    }

private:
    RTCDevice device_;
};

/// A model's triangles as Embree's user geometry: the only kind that rtcCollide() takes.
class EmbreeBody {
public:
    using Contact = study::NaiveContact<float>;

    EmbreeBody(RTCDevice device, const Model& model, RTCBuildQuality quality)
        : mesh_(model), scene_(rtcNewScene(device)) {
        place(Pose());
        geometry_ = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(corners_.size()));
        rtcSetGeometryUserData(geometry_, this);
        rtcSetGeometryBoundsFunction(geometry_, bound, nullptr);
        rtcSetGeometryBuildQuality(geometry_, quality);
        if (quality == RTC_BUILD_QUALITY_REFIT) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
        rtcAttachGeometry(scene_, geometry_);
        commit();
    }
    EmbreeBody(const EmbreeBody&) = delete;
    EmbreeBody& operator=(const EmbreeBody&) = delete;
    ~EmbreeBody() {
        rtcReleaseGeometry(geometry_);
        rtcReleaseScene(scene_);
    }

    void move(const Pose& pose) {
        place(pose);
        commit();
    }
    [[nodiscard]] RTCScene scene() const {
        return scene_;
    }
    [[nodiscard]] const Contact::Corners& corners(unsigned triangle) const {
        return corners_[triangle];
    }

private:
    void place(const Pose& pose) {
        corners_.clear();
        for (const auto& t : mesh_.triangles) {
            corners_.push_back(Contact::rounded({transform_point(pose, mesh_.points[t[0]]),
                                                 transform_point(pose, mesh_.points[t[1]]),
                                                 transform_point(pose, mesh_.points[t[2]])}));
        }
    }
    void commit() {
        rtcCommitGeometry(geometry_);
        rtcCommitScene(scene_);
    }
    static void bound(const RTCBoundsFunctionArguments* asked) {
        const auto& body = *static_cast<const EmbreeBody*>(asked->geometryUserPtr);
        const Contact::Corners& t = body.corners_[asked->primID];
        const auto low = [&](std::size_t k) { return std::min({t[0][k], t[1][k], t[2][k]}); };
        const auto high = [&](std::size_t k) { return std::max({t[0][k], t[1][k], t[2][k]}); };
        RTCBounds& box = *asked->bounds_o;
        box = {low(0), low(1), low(2), 0, high(0), high(1), high(2), 0};
    }

    Mesh mesh_;
    std::vector<Contact::Corners> corners_;
    RTCScene scene_;
    RTCGeometry geometry_ = nullptr;
};

class Embree final : public Peer {
public:
    Embree(const Model& a, const Model& b)
        : a_(device_.get(), a, RTC_BUILD_QUALITY_MEDIUM),
          b_(device_.get(), b, RTC_BUILD_QUALITY_REFIT) {}
    [[nodiscard]] const char* key() const override {
        return "embree";
    }
    [[nodiscard]] std::string name() const override {
        return "Embree " RTC_VERSION_STRING;
    }
    [[nodiscard]] std::string note() const override {
        return "rtcCollide: pairs of boxes, whose triangles are tested here by signs of volumes in "
               "float; boxes cannot rotate, so B is moved and its tree is refitted at each pose; "
               "the search does not end at the first hit";
    }
    [[nodiscard]] std::string find_reason(char letter) const override {
        return letter == 'c' || letter == 'o' ? "" : "has no distance query for meshes";
    }
    std::size_t ask(char letter, const Pose& a_from_b) override {
        b_.move(a_from_b);
        found_ = 0;
        rtcCollide(a_.scene(), b_.scene(), take, this);
        return letter == 'c' ? std::min<std::size_t>(1, found_) : found_;
    }

private:
    static void take(void* self, RTCCollision* collisions, unsigned count) {
        auto& peer = *static_cast<Embree*>(self);
        for (unsigned i = 0; i < count; ++i) {
            const RTCCollision& pair = collisions[i];
            if (peer.contact_.touch(peer.a_.corners(pair.primID0), peer.b_.corners(pair.primID1))) {
                ++peer.found_;
            }
        }
    }

    EmbreeDevice device_;
    EmbreeBody a_;
    EmbreeBody b_;
    EmbreeBody::Contact contact_{0};
    std::size_t found_ = 0;
};
#endif

/// What building a structure came to.
struct Built {
    std::vector<double> seconds;
    std::size_t vertices = 0;  ///< of a hull; 0 of trees
    std::size_t facets = 0;
};

#ifdef CDPREP_HAVE_QHULL
Built build_hull(const Mesh& mesh) {
    std::vector<double> numbers;
    for (const Double3& p : mesh.points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    Built built;
    qhT qhull;
    qh_zero(&qhull, stderr);
    std::array<char, 9> command = {"qhull Qt"};
    const double before = thread_seconds();
    const int failed = qh_new_qhull(&qhull, 3, static_cast<int>(mesh.points.size()), numbers.data(),
                                    0, command.data(), nullptr, nullptr);
    built.seconds.push_back(thread_seconds() - before);
    if (failed == 0) {
        built.vertices = static_cast<std::size_t>(qhull.num_vertices);
        built.facets = static_cast<std::size_t>(qhull.num_facets);
    }
    qh_freeqhull(&qhull, !qh_ALL);
    int current = 0;
    int total = 0;
    qh_memfreeshort(&qhull, &current, &total);
    return built;
}
#endif

/// What a peer took and said, of the cases that ask it.
struct Answered {
    std::vector<std::vector<double>> seconds;  ///< by case and round
    std::vector<std::size_t> answers;
};

Answered ask_all(Peer& peer, char letter, const std::vector<Case>& cases, std::size_t rounds,
                 double budget) {
    std::vector<const Case*> asked;
    for (const Case& one : cases) {
        if (one.letters.find(letter) != std::string::npos) asked.push_back(&one);
    }
    Answered answered;
    answered.seconds.resize(asked.size());
    answered.answers.resize(asked.size());
    const double begun = thread_seconds();
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round > 0 && thread_seconds() - begun > budget) break;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            const double before = thread_seconds();
            answered.answers[i] = peer.ask(letter, asked[i]->a_from_b);
            answered.seconds[i].push_back(thread_seconds() - before);
        }
    }
    return answered;
}

template <class Number>
void print_list(const std::vector<Number>& numbers) {
    std::printf("[");
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::printf("%s%.9g", i > 0 ? ", " : "", static_cast<double>(numbers[i]));
    }
    std::printf("]");
}

/// The libraries, and why those that cannot be asked are not.
struct Absent {
    const char* key;
    const char* name;
    const char* reason;
};

[[maybe_unused]] constexpr const char* kLacks =
    "its package was not installed when peers was built";
constexpr const char* kNoPackage = "no Debian package; its licence is for research only";

std::vector<Absent> absent_peers() {
    std::vector<Absent> absent = {{"pqp", "PQP", kNoPackage}, {"swift", "SWIFT++", kNoPackage}};
#ifndef CDPREP_HAVE_FCL
    absent.push_back({"fcl", "FCL", kLacks});
#endif
#ifndef CDPREP_HAVE_ODE
    absent.push_back({"ode", "ODE", kLacks});
#endif
#ifndef CDPREP_HAVE_BULLET
    absent.push_back({"bullet", "Bullet", kLacks});
#endif
#ifndef CDPREP_HAVE_CGAL
    absent.push_back({"cgal", "CGAL", kLacks});
#endif
#ifndef CDPREP_HAVE_EMBREE
    absent.push_back({"embree", "Embree", kLacks});
#endif
#ifndef CDPREP_HAVE_QHULL
    absent.push_back({"qhull", "qhull", kLacks});
#endif
    return absent;
}

void print_absent(const std::vector<Absent>& absent) {
    std::printf("\"absent\": [");
    for (std::size_t i = 0; i < absent.size(); ++i) {
        std::printf("%s{\"key\": \"%s\", \"name\": \"%s\", \"reason\": \"%s\"}",
                    i > 0 ? ",\n  " : "", absent[i].key, absent[i].name, absent[i].reason);
    }
    std::printf("]}\n");
}

/// Asks each peer and prints what it says.
class Pairs {
public:
    void add(Peer& peer) {
        std::printf("%s  {\"key\": \"%s\", \"name\": \"%s\", \"note\": \"%s\"", separator(),
                    peer.key(), peer.name().c_str(), peer.note().c_str());
        std::string reasons;
        for (std::size_t q = 0; q < kLetters.size(); ++q) {
            const std::string reason = peer.find_reason(kLetters[q]);
            if (!reason.empty()) {
                reasons += std::string(reasons.empty() ? "" : ", ") + "\"" + kNames[q] + "\": \"" +
                           reason + "\"";
                continue;
            }
            print(kNames[q], ask_all(peer, kLetters[q], cases, rounds, budget));
        }
        std::printf(",\n   \"reasons\": {%s}}", reasons.c_str());
        std::fflush(stdout);
    }

    std::vector<Case> cases;
    std::size_t rounds = 1;
    double budget = 1;

private:
    static void print(const char* name, const Answered& answered) {
        std::printf(",\n   \"%s\": {\"seconds\": [", name);
        for (std::size_t i = 0; i < answered.seconds.size(); ++i) {
            if (i > 0) std::printf(", ");
            print_list(answered.seconds[i]);
        }
        std::printf("], \"answers\": ");
        print_list(answered.answers);
        std::printf("}");
    }
    const char* separator() {
        return std::exchange(is_first_, false) ? "\n" : ",\n";
    }
    bool is_first_ = true;
};

/// Builds each peer's structure and prints what that takes.
class Builds {
public:
    /// `build` returns a Built of one time, or a structure, which is then timed here.
    template <class Build>
    void add(const char* key, const std::string& name, const std::string& note, Build build) {
        Built all;
        const double begun = thread_seconds();
        for (std::size_t round = 0; round < rounds; ++round) {
            if (round > 0 && thread_seconds() - begun > budget) break;
            const Built one = build();
            all.seconds.insert(all.seconds.end(), one.seconds.begin(), one.seconds.end());
            all.vertices = one.vertices;
            all.facets = one.facets;
        }
        std::printf("%s  {\"key\": \"%s\", \"name\": \"%s\", \"note\": \"%s\", \"seconds\": ",
                    std::exchange(is_first_, false) ? "\n" : ",\n", key, name.c_str(),
                    note.c_str());
        print_list(all.seconds);
        std::printf(", \"vertices\": %zu, \"facets\": %zu}", all.vertices, all.facets);
    }

    std::size_t rounds = 1;
    double budget = 1;

private:
    bool is_first_ = true;
};

/// Times what makes a structure, and not what takes it down.
template <class Make>
Built timed(Make make) {
    const double before = thread_seconds();
    const auto made = make();
    return {{thread_seconds() - before}};
}

int ask_pair(const std::vector<std::string>& arguments) {
    const Model a = open_or_stop(arguments[0]);
    const Model b = open_or_stop(arguments[1]);
    Pairs pairs;
    pairs.cases = read_cases(arguments[2]);
    [[maybe_unused]] const double tolerance = std::strtod(arguments[3].c_str(), nullptr);
    pairs.rounds = std::max<std::size_t>(1, std::strtoul(arguments[4].c_str(), nullptr, 10));
    pairs.budget = std::strtod(arguments[5].c_str(), nullptr);
    std::printf("{\"peers\": [");
#ifdef CDPREP_HAVE_FCL
    pairs.add(*std::make_unique<Fcl>(a, b, tolerance));
#endif
#ifdef CDPREP_HAVE_ODE
    pairs.add(*std::make_unique<Ode>(a, b));
#endif
#ifdef CDPREP_HAVE_BULLET
    pairs.add(*std::make_unique<Bullet>(a, b));
#endif
#ifdef CDPREP_HAVE_CGAL
    pairs.add(*std::make_unique<Cgal>(a, b));
#endif
#ifdef CDPREP_HAVE_EMBREE
    pairs.add(*std::make_unique<Embree>(a, b));
#endif
    std::printf("],\n ");
    print_absent(absent_peers());
    return 0;
}

int build_all(const std::vector<std::string>& arguments) {
    const Model model = open_or_stop(arguments[0]);
    [[maybe_unused]] const Mesh mesh(model);
    Builds builds;
    builds.rounds = std::max<std::size_t>(1, std::strtoul(arguments[1].c_str(), nullptr, 10));
    builds.budget = std::strtod(arguments[2].c_str(), nullptr);
    std::printf("{\"builds\": [");
#ifdef CDPREP_HAVE_QHULL
    builds.add("qhull", std::string("qhull ") + qh_version, "option Qt",
               [&] { return build_hull(mesh); });
#endif
#ifdef CDPREP_HAVE_FCL
    builds.add("fcl", "FCL " FCL_VERSION, "oriented boxes",
               [&] { return timed([&] { return fcl_model<fcl::OBBd>(model); }); });
    builds.add("fcl_swept", "FCL " FCL_VERSION, "swept rectangles, as in PQP",
               [&] { return timed([&] { return fcl_model<fcl::RSSd>(model); }); });
#endif
#ifdef CDPREP_HAVE_ODE
    builds.add("ode", "ODE 0.16 (OPCODE)", "includes copies of the triangles",
               [&] { return timed([&] { return std::make_unique<Ode::Alone>(model); }); });
#endif
#ifdef CDPREP_HAVE_BULLET
    builds.add("bullet", "Bullet " + std::to_string(BT_BULLET_VERSION) + " (GImpact)",
               "includes copies of the triangles",
               [&] { return timed([&] { return std::make_unique<Bullet::Body>(model); }); });
#endif
#ifdef CDPREP_HAVE_CGAL
    builds.add("cgal", "CGAL " CGAL_VERSION_STR, "a surface mesh and its tree of boxes",
               [&] { return timed([&] { return std::make_unique<Cgal::Alone>(model); }); });
#endif
#ifdef CDPREP_HAVE_EMBREE
    const EmbreeDevice device;
    builds.add("embree", "Embree " RTC_VERSION_STRING, "user geometry, medium quality", [&] {
        return timed([&] {
            return std::make_unique<EmbreeBody>(device.get(), model, RTC_BUILD_QUALITY_MEDIUM);
        });
    });
#endif
    std::printf("],\n ");
    print_absent(absent_peers());
    return 0;
}

int main_of(const std::vector<std::string>& words) {
    const std::vector<std::string> rest(words.begin() + (words.empty() ? 0 : 1), words.end());
    if (!words.empty() && words[0] == "pair" && rest.size() == 6) return ask_pair(rest);
    if (!words.empty() && words[0] == "build" && rest.size() == 3) return build_all(rest);
    stop("Usage: see the comment at the top of peers.cpp.");
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    return cdprep::main_of({arguments + 1, arguments + count});
}
