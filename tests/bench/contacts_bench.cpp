// SPDX-License-Identifier: MIT
// The time of contacts() through the BVHs and through those over the pieces, without a manifold and
// with one, and with a limit of 16: the deepest, and others spread over the surface.
//
// Beside it, if found at configure time: FCL, with a point and a normal for every pair of triangles
// that touches (no pieces, no tolerance), and with a limit of 16, which are the first 16 it meets;
// and Bullet, as Debian builds it in float, with a compound of the hulls of the same pieces: the
// nearest points of every pair of them or, for the manifold, faces clipped by each other.
// Contenders take turns, several rounds; the time of a pose is the median of its rounds, warm.
// Processor time, one thread.
//
// Usage: contacts_bench BAKES POSES [ROUNDS [PAIR...]]
// as pair_queries_bench: models normalised, baked with --effects contacts; line i of a file is
// of kind i mod 3. `light` and `deep` poses are asked with tolerance 0, `near` ones, 1 % of the
// diagonal apart, with 1.2 %. A walk begins at the first pose of its kind and moves by 1/1000
// of the diagonal along x from question to question.
//
// Prints a CSV table, microseconds; `contacts` is the mean number of pairs of pieces (of FCL: of
// triangles), `points` of their points, `times` the median by that of boxes. Then, for ours, what
// a question took in the mean: boxes against boxes, triangles against triangles, pairs of hulls
// and steps between them.
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/contacts.h"
#include "cdprep/hulls.h"

#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif
#ifdef CDPREP_HAVE_BULLET
#include <BulletCollision/btBulletCollisionCommon.h>

#include "bullet_transform.h"
#endif

namespace cdprep {
namespace {

constexpr std::size_t kMostContacts = 1U << 18;
constexpr std::uint32_t kFew = 16;  ///< contacts of a list with a limit
constexpr double kNearTolerance = 0.012;
constexpr double kStep = 0.001;  ///< of a walk
constexpr std::size_t kSteps = 50;

/// What is asked of every pose of a set.
struct Question {
    double tolerance;
    Manifold manifold;
};

struct Found {
    std::size_t contacts = 0;
    std::size_t points = 0;
};

class Contender {
public:
    virtual ~Contender() = default;
    [[nodiscard]] virtual const char* name() const = 0;
    [[nodiscard]] virtual bool can_ask(const Question& /*question*/) const {
        return true;
    }
    virtual Found ask(const Question& question, const Pose& pose) = 0;
    /// What one more asking of the set does, where that is counted.
    virtual QueryCounts counts(const Question& /*question*/, const std::vector<Pose>& /*poses*/) {
        return {};
    }
};

class Ours final : public Contender {
public:
    Ours(const Model& a, const Model& b, Structure structure, std::uint32_t most = 0)
        : a_(a), b_(b), structure_(structure), most_(most), contacts_(kMostContacts) {}
    [[nodiscard]] const char* name() const override {
        if (most_ > 0) return "boxes_16";
        return structure_ == Structure::pieces ? "pieces" : "boxes";
    }
    Found ask(const Question& question, const Pose& pose) override {
        Found found;
        found.contacts =
            contacts(
                {a_, b_, Placement::b_moves(pose), {.through = structure_}}, workspace_, contacts_,
                {.tolerance = question.tolerance, .manifold = question.manifold, .most = most_})
                .count;
        for (std::size_t i = 0; i < std::min(found.contacts, kMostContacts); ++i) {
            found.points += contacts_[i].point_count;
        }
        return found;
    }
    QueryCounts counts(const Question& question, const std::vector<Pose>& poses) override {
        QueryCounts sum;
        workspace_.count_into(&sum);
        for (const Pose& pose : poses) ask(question, pose);
        workspace_.count_into(nullptr);
        return sum;
    }

private:
    const Model& a_;
    const Model& b_;
    Structure structure_;
    std::uint32_t most_;  ///< 0: all
    Workspace workspace_;
    std::vector<Contact> contacts_;
};

#ifdef CDPREP_HAVE_FCL
class Fcl final : public Contender {
public:
    Fcl(const Model& a, const Model& b, std::size_t most)
        : a_(fcl_model<fcl::OBBd>(a)), b_(fcl_model<fcl::OBBd>(b)), most_(most) {}
    [[nodiscard]] const char* name() const override {
        return most_ == kMostContacts ? "fcl" : "fcl_16";
    }
    [[nodiscard]] bool can_ask(const Question& question) const override {
        return question.tolerance == 0 && question.manifold == Manifold::none;
    }
    Found ask(const Question& /*question*/, const Pose& pose) override {
        fcl::CollisionResultd result;
        fcl::collide(&a_, fcl::Transform3d::Identity(), &b_, fcl_transform(pose),
                     fcl::CollisionRequestd(most_, true), result);
        return {result.numContacts(), result.numContacts()};
    }

private:
    fcl::BVHModel<fcl::OBBd> a_;
    fcl::BVHModel<fcl::OBBd> b_;
    std::size_t most_;
};
#endif

#ifdef CDPREP_HAVE_BULLET
/// The hulls of all pieces as one shape.
class BulletPieces {
public:
    BulletPieces(const Model& model, Manifold manifold) : shape_(true) {
        shape_.setMargin(0);
        for (std::uint32_t i = 0; i < model.pieces().pieces.size(); ++i) {
            auto hull = std::make_unique<btConvexHullShape>();
            const ConvexPoints points = piece_points(model, i);
            for (std::uint32_t k = 0; k < points.count; ++k) {
                hull->addPoint(bullet_vector(points.point(k)), false);
            }
            hull->setMargin(0);
            hull->recalcLocalAabb();
            if (manifold == Manifold::four) hull->initializePolyhedralFeatures();
            shape_.addChildShape(btTransform::getIdentity(), hull.get());
            hulls_.push_back(std::move(hull));
        }
        object_.setCollisionShape(&shape_);
    }
    [[nodiscard]] btCollisionObject& object() {
        return object_;
    }

private:
    std::vector<std::unique_ptr<btConvexHullShape>> hulls_;
    btCompoundShape shape_;
    btCollisionObject object_;
};

/// Counts points, and the pairs of pieces that they are of, which come one after the other.
struct CountPoints final : btCollisionWorld::ContactResultCallback {
    Found found;
    int last_a = -1, last_b = -1;

    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* /*a*/,
                             int /*part_a*/, int index_a, const btCollisionObjectWrapper* /*b*/,
                             int /*part_b*/, int index_b) override {
        if (point.getDistance() > m_closestDistanceThreshold) return 0;
        ++found.points;
        found.contacts += index_a != last_a || index_b != last_b ? 1 : 0;
        last_a = index_a;
        last_b = index_b;
        return 0;
    }
};

class Bullet final : public Contender {
public:
    Bullet(const Model& a, const Model& b)
        : nearest_a_(a, Manifold::none),
          nearest_b_(b, Manifold::none),
          faces_a_(a, Manifold::four),
          faces_b_(b, Manifold::four),
          dispatcher_(&configuration_),
          world_(&dispatcher_, &broad_phase_, &configuration_) {
        gContactBreakingThreshold = 0;  // the tolerance alone says what is near
    }
    [[nodiscard]] const char* name() const override {
        return "bullet";
    }
    Found ask(const Question& question, const Pose& pose) override {
        const bool clips = question.manifold == Manifold::four;
        btCollisionObject& a = (clips ? faces_a_ : nearest_a_).object();
        btCollisionObject& b = (clips ? faces_b_ : nearest_b_).object();
        a.setWorldTransform(btTransform::getIdentity());
        b.setWorldTransform(bullet_transform(pose));
        CountPoints count;
        count.m_closestDistanceThreshold = static_cast<btScalar>(question.tolerance);
        world_.contactPairTest(&a, &b, count);
        return count.found;
    }

private:
    BulletPieces nearest_a_, nearest_b_, faces_a_, faces_b_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    btCollisionWorld world_;
};
#endif

/// Poses and what is asked of them.
struct Situation {
    std::string name;
    std::vector<Pose> poses;
    double tolerance;
};

std::vector<Pose> walk_from(const Pose& start) {
    const auto& r = start.rotation();
    const Double3& t = start.translation();
    std::vector<Pose> walk;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double x = t.x + kStep * static_cast<double>(i);
        walk.push_back(
            Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], x, t.y, t.z})
                .value());
    }
    return walk;
}

std::vector<Situation> situations(const std::vector<Pose>& all) {
    constexpr std::array<const char*, 3> kKinds = {"light", "deep", "near"};
    std::vector<Situation> result;
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        const std::vector<Pose> poses = poses_of_kind(all, kind, kKinds.size());
        const double tolerance = kind == 2 ? kNearTolerance : 0;
        const std::string name = kKinds[kind];
        result.push_back({name, poses, tolerance});
        if (kind > 0) result.push_back({name + "_walk", walk_from(poses[0]), tolerance});
    }
    return result;
}

/// What one contender took for one question over one set.
struct Times {
    std::vector<std::vector<double>> us;  ///< [pose][round]
    Found found;                          ///< of all poses

    [[nodiscard]] std::vector<double> by_pose() const {
        std::vector<double> result;
        for (const auto& rounds : us) result.push_back(median(rounds));
        return result;
    }
};

void ask_set(Contender& contender, const Question& question, const std::vector<Pose>& poses,
             Times& times) {
    times.us.resize(poses.size());
    times.found = {};
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const double begun = thread_us();
        const Found found = contender.ask(question, poses[i]);
        times.us[i].push_back(thread_us() - begun);
        times.found.contacts += found.contacts;
        times.found.points += found.points;
    }
}

/// Medians of a pair of models, for the summary.
using Ratios = std::map<std::string, std::vector<double>>;

void compare(const std::string& pair, const std::vector<std::unique_ptr<Contender>>& contenders,
             const Situation& situation, Manifold manifold, int rounds, Ratios& ratios) {
    const Question question = {situation.tolerance, manifold};
    std::vector<Times> times(contenders.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            if (!contenders[c]->can_ask(question)) continue;
            ask_set(*contenders[c], question, situation.poses, times[c]);
        }
    }
    const double ours = median(times[0].by_pose());
    const auto count = static_cast<double>(situation.poses.size());
    for (std::size_t c = 0; c < contenders.size(); ++c) {
        if (times[c].us.empty()) continue;
        const std::vector<double> us = times[c].by_pose();
        const std::string key =
            std::string(manifold == Manifold::four ? "manifold/" : "contacts/") + situation.name +
            "," + contenders[c]->name();
        const QueryCounts counts = contenders[c]->counts(question, situation.poses);
        const auto mean = [&](auto sum) { return static_cast<double>(sum) / count; };
        std::printf("%s,%s,%zu,%.1f,%.1f,%.2f,%.2f,%.2f,%.1f,%.1f,%.1f,%.1f\n", pair.c_str(),
                    key.c_str(), situation.poses.size(), mean(times[c].found.contacts),
                    mean(times[c].found.points), median(us), median(us, 0.95), median(us) / ours,
                    mean(counts.box_pairs), mean(counts.triangle_pairs), mean(counts.hull_pairs),
                    mean(counts.hull_steps));
        if (c > 0) ratios[key].push_back(median(us) / ours);
    }
    std::fflush(stdout);
}

void run(const std::filesystem::path& bakes, const std::filesystem::path& poses_folder,
         const std::vector<std::string>& pairs, int rounds) {
    std::printf(
        "pair,question,contender,poses,contacts,points,median_us,p95_us,times,"
        "box_pairs,triangle_pairs,hull_pairs,hull_steps\n");
    Ratios ratios;
    for (const std::string& pair : pairs) {
        const std::size_t dash = pair.find('-');
        if (dash == std::string::npos) stop("'" + pair + "' is not two names with a dash between");
        const Model a = open_or_stop(bakes / (pair.substr(0, dash) + ".cdp.h5"));
        const Model b = open_or_stop(bakes / (pair.substr(dash + 1) + ".cdp.h5"));
        if (a.pieces().of_triangle.empty() || b.pieces().of_triangle.empty()) {
            stop(pair + " was baked without --effects contacts");
        }
        std::vector<std::unique_ptr<Contender>> contenders;
        contenders.push_back(std::make_unique<Ours>(a, b, Structure::bvh));
        contenders.push_back(std::make_unique<Ours>(a, b, Structure::pieces));
        contenders.push_back(std::make_unique<Ours>(a, b, Structure::bvh, kFew));
#ifdef CDPREP_HAVE_FCL
        contenders.push_back(std::make_unique<Fcl>(a, b, kMostContacts));
        contenders.push_back(std::make_unique<Fcl>(a, b, kFew));
#endif
#ifdef CDPREP_HAVE_BULLET
        contenders.push_back(std::make_unique<Bullet>(a, b));
#endif
        for (const Situation& situation : situations(read_poses(poses_folder / (pair + ".pose")))) {
            for (const Manifold manifold : {Manifold::none, Manifold::four}) {
                compare(pair, contenders, situation, manifold, rounds, ratios);
            }
        }
    }
    for (const auto& [key, values] : ratios) {
        std::printf("median of %zu pairs,%s,,,,,,%.2f\n", values.size(), key.c_str(),
                    median(values));
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    const auto [bakes, poses, pairs, rounds] = cdprep::pair_arguments(count, arguments);
    cdprep::run(bakes, poses, pairs, rounds);
}
