// SPDX-License-Identifier: MIT
// A scene of many scans that all move a little each frame: which collide, which are near, how far
// apart they are.
//
// Beside it, if found at configure time: FCL's dynamic tree over the same objects, with its
// oriented boxes and spheres (OBBRSS) inside. The numbers of pairs found are printed: they must
// agree.
//
// Usage: scene_bench BODIES FRAMES MODEL... [all MODEL...]
// Models are bakes with --effects collide,within,distance, normalised to a diagonal of 1. Body i is
// of model i mod the number of models. Models behind `all` are the same meshes baked with
// everything: `cdprep_all` shows what the other sections cost a scene that does not ask for them.
//
// Prints a CSV table: milliseconds of the thread's time for each frame, poses included, and for
// each candidate microseconds. `times` is relative to ours. Contenders take turns at each frame.
// Pairs found must be equal, or the program stops.
//
// A line follows about candidates that do not touch, each asked alone, of the models behind `all`
// if there are any. It states how many of them their root boxes rule out, and the median time of
// all and of the others. Where models behind `all` have hulls, a second line states how many of the
// others their hulls rule out, and in what time.
//
// A second table is of the bodies as they are at first: which pairs are within a distance (0.5 % of
// the scene's size, and the tolerance above), and how far apart those are. Each contender begins
// with models and poses alone, and they take turns. FCL's manager calls back with pairs whose boxes
// are that near; `fcl_bounded` tells its search for the distance of two meshes so too. The pairs
// found must be equal, or the program stops. `asked` counts the pairs of meshes that are asked.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/object_box.h"
#include "cdprep/hulls.h"
#include "cdprep/scene.h"

#ifdef CDPREP_HAVE_FCL
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include "fcl_models.h"
#endif

namespace cdprep {
namespace {

constexpr double kSpace = 0.55;  ///< of a body, by the diagonal of a model
constexpr double kStep = 0.005;  ///< of a body in a frame, likewise
constexpr double kTurn = 0.01;   ///< of a body in a frame, radians
constexpr double kTolerance = 0.005;

/// Bodies that move straight and turn.
class Bodies {
public:
    Bodies(std::size_t count, std::uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> within(0, kSpace * std::cbrt(double(count)));
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < count; ++i) {
            Body body{};
            for (double& c : body.at) c = within(random);
            for (double& c : body.step) c = normal(random) * kStep / std::sqrt(3);
            for (double& c : body.turn) c = normal(random);
            for (double& c : body.axis) c = normal(random) * kTurn;
            bodies_.push_back(body);
        }
        step();
    }
    void step() {
        poses_.clear();
        for (Body& body : bodies_) {
            for (std::size_t i = 0; i < 3; ++i) body.at[i] += body.step[i];
            for (std::size_t i = 0; i < 4; ++i) body.turn[i] += body.axis[i];
            poses_.push_back(Pose::from_quaternion(body.turn[0], body.turn[1], body.turn[2],
                                                   body.turn[3],
                                                   {body.at[0], body.at[1], body.at[2]})
                                 .value());
        }
    }
    [[nodiscard]] const std::vector<Pose>& poses() const {
        return poses_;
    }

private:
    struct Body {
        std::array<double, 3> at, step;
        std::array<double, 4> turn, axis;
    };
    std::vector<Body> bodies_;
    std::vector<Pose> poses_;
};

class Contender {
public:
    virtual ~Contender() = default;
    /// Returns the number of pairs found.
    virtual std::size_t frame(const std::vector<Pose>& poses) = 0;
    [[nodiscard]] virtual std::uint64_t candidates() const {
        return 0;
    }
};

class Ours final : public Contender {
public:
    Ours(const std::vector<Model>& models, const std::vector<Pose>& poses, const LayerPair& pair)
        : plan_(plan_of(pair, poses.size())), scene_(plan_), workspaces_(1) {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            objects_.push_back(*scene_.add({&models[i % models.size()], 0, poses[i]}));
        }
    }
    std::size_t frame(const std::vector<Pose>& poses) override {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            static_cast<void>(scene_.set_pose(objects_[i], poses[i]));
        }
        if (!scene_.step(workspaces_).complete) stop("There is too little room for pairs.");
        return scene_.hits().size();
    }
    [[nodiscard]] std::uint64_t candidates() const override {
        return scene_.counts().candidates;
    }

private:
    static Plan plan_of(const LayerPair& pair, std::size_t objects) {
        const auto count = static_cast<std::uint32_t>(objects);
        auto made =
            Plan::compile({.pairs = {&pair, 1}, .limits = {.objects = count, .pairs = 64 * count}});
        if (!made.plan) stop(made.refusals[0]);
        return *made.plan;
    }

    Plan plan_;
    Scene scene_;
    std::vector<Workspace> workspaces_;
    std::vector<ObjectId> objects_;
};

#ifdef CDPREP_HAVE_FCL
class Fcl final : public Contender {
public:
    Fcl(const std::vector<Model>& models, const std::vector<Pose>& poses) {
        std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes;
        for (const Model& model : models) {
            shapes.push_back(
                std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>(fcl_model<fcl::OBBRSSd>(model)));
            shapes.back()->computeLocalAABB();
        }
        for (std::size_t i = 0; i < poses.size(); ++i) {
            objects_.push_back(std::make_unique<fcl::CollisionObjectd>(shapes[i % shapes.size()],
                                                                       fcl_transform(poses[i])));
            objects_.back()->computeAABB();
            manager_.registerObject(objects_.back().get());
        }
        manager_.setup();
    }
    std::size_t frame(const std::vector<Pose>& poses) override {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            objects_[i]->setTransform(fcl_transform(poses[i]));
            objects_[i]->computeAABB();
        }
        manager_.update();
        std::size_t found = 0;
        manager_.collide(&found,
                         [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* count) {
                             fcl::CollisionResultd result;
                             fcl::collide(a, b, fcl::CollisionRequestd(1, false), result);
                             *static_cast<std::size_t*>(count) += result.isCollision() ? 1 : 0;
                             return false;
                         });
        return found;
    }

private:
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
    fcl::DynamicAABBTreeCollisionManagerd manager_;
};
#endif

/// `whole` are the models baked with everything, or empty.
void compare(const std::vector<Model>& models, const std::vector<Model>& whole, std::size_t bodies,
             int frames, const LayerPair& pair) {
    Bodies start(bodies, 1);
    std::vector<std::pair<const char*, std::unique_ptr<Contender>>> contenders;
    contenders.emplace_back("cdprep", std::make_unique<Ours>(models, start.poses(), pair));
    if (!whole.empty()) {
        contenders.emplace_back("cdprep_all", std::make_unique<Ours>(whole, start.poses(), pair));
    }
#ifdef CDPREP_HAVE_FCL
    if (pair.effects == Ask::collide) {
        contenders.emplace_back("fcl_obbrss", std::make_unique<Fcl>(models, start.poses()));
    }
#endif
    Bodies moving(bodies, 1);
    std::vector<std::vector<double>> ms(contenders.size());
    std::vector<std::size_t> pairs(contenders.size());
    constexpr int kWarm = 3;
    for (int frame = -kWarm; frame < frames; ++frame) {
        moving.step();
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            const double begun = thread_us();
            pairs[i] = contenders[i].second->frame(moving.poses());
            if (frame >= 0) ms[i].push_back((thread_us() - begun) / 1000);
            if (pairs[i] != pairs[0]) {
                stop(std::string(contenders[i].first) + " finds other pairs.");
            }
        }
    }
    const auto candidates = static_cast<double>(contenders[0].second->candidates());
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const double middle = median(ms[i]);
        std::printf("%s,%s,%zu,%.0f,%zu,%.3f,%.3f,%.3f,%.3f\n", find_needs(pair.effects)->name,
                    contenders[i].first, bodies, candidates, pairs[i], middle, median(ms[i], 0.95),
                    1000 * middle / candidates, middle / median(ms[0]));
    }
    std::fflush(stdout);
}

// --- A scene without motion ----------------------------------------------------------------

constexpr double kShareOfScene = 0.005;

/// The pairs within a distance, sorted, and the pairs of meshes that were asked.
struct Clashes {
    std::vector<BoxPair> found;
    std::uint64_t asked = 0;
};

/// A scene without motion. Bodies are numbered as their poses.
struct Still {
    const std::vector<Model>& models;
    std::vector<Pose> poses;
    double tolerance;

    [[nodiscard]] const Model& model(std::size_t body) const {
        return models[body % models.size()];
    }
};

double diagonal(const std::vector<Model>& models, const std::vector<Pose>& poses) {
    std::array<double, 3> lower{}, upper{};
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const WorldBox box = world_box(root_box(models[i % models.size()], poses[i], 0));
        for (std::size_t k = 0; k < 3; ++k) {
            lower[k] = i == 0 ? box.lower[k] : std::min(lower[k], double{box.lower[k]});
            upper[k] = i == 0 ? box.upper[k] : std::max(upper[k], double{box.upper[k]});
        }
    }
    return std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
}

/// Calls visit(bodies, whether their root boxes may meet, the pair) for all pairs whose boxes meet.
template <class Visit>
void visit_candidates(const Still& still, const Visit& visit) {
    std::vector<RootBox> roots;
    std::vector<WorldBox> boxes;
    for (std::size_t i = 0; i < still.poses.size(); ++i) {
        roots.push_back(root_box(still.model(i), still.poses[i], still.tolerance / 2));
        boxes.push_back(world_box(roots.back()));
    }
    const auto count = static_cast<std::uint32_t>(boxes.size());
    BroadPhase broad_phase({.boxes = count, .pairs = 64 * count});
    const BroadPhaseUpdate update = broad_phase.update(boxes);
    if (!update.complete) stop("There is too little room for pairs.");
    for (const BoxPair& pair : update.pairs) {
        visit(pair, roots[pair.a], roots[pair.b],
              Pair{still.model(pair.a), still.model(pair.b),
                   Placement::world(still.poses[pair.a], still.poses[pair.b])});
    }
}

/// As `cdprep query within --scene` and `query distance --scene` do it.
template <class Near>
Clashes our_clashes(const Still& still, const Near& is_near) {
    Clashes clashes;
    visit_candidates(
        still, [&](const BoxPair& bodies, const RootBox& a, const RootBox& b, const Pair& pair) {
            if (!may_meet(a, b)) return;
            ++clashes.asked;
            if (is_near(pair)) clashes.found.push_back(bodies);
        });
    return clashes;
}

/// Times what decides candidates that do not touch, each alone.
struct Misses {
    std::vector<double> all;    ///< root boxes, then the walk of those that they leave
    std::vector<double> asked;  ///< those that root boxes leave
    std::vector<double> hulls;  ///< the hulls of the same, each from the simplex of the last query
    std::size_t apart = 0;      ///< of these, pairs of hulls that do not touch
    double walks = 0;           ///< sum of what hulls were asked of, by the walk alone
    double hulls_first = 0;     ///< sum by hulls, and by the walk where hulls touch
};

constexpr int kRepeats = 32;

/// Returns microseconds of one call.
template <class Query>
double time_repeated(const Query& query) {
    const double begun = thread_us();
    for (int i = 0; i < kRepeats; ++i) query();
    return (thread_us() - begun) / kRepeats;
}

/// Asks the hulls of a pair, if both models have one. A walk takes `walk` microseconds.
void time_hulls(const Pair& pair, double walk, Misses& misses) {
    if (!pair.a.get().serves(Ask::hulls) || !pair.b.get().serves(Ask::hulls)) return;
    const auto a = find_hull(pair.a, format::HullScope::whole);
    const auto b = find_hull(pair.b, format::HullScope::whole);
    if (!a || !b) return;
    const ConvexPoints points_a = convex_points(pair.a, *a), points_b = convex_points(pair.b, *b);
    ConvexCache cache;
    bool touch = convex_collide(points_a, points_b, pair.placement, &cache);
    const double hulls =
        time_repeated([&] { touch = convex_collide(points_a, points_b, pair.placement, &cache); });
    misses.hulls.push_back(hulls);
    misses.apart += touch ? 0 : 1;
    misses.walks += walk;
    misses.hulls_first += hulls + (touch ? walk : 0);
}

void time_misses(const Still& still) {
    Workspace workspace;
    Misses misses;
    visit_candidates(still,
                     [&](const BoxPair&, const RootBox& a, const RootBox& b, const Pair& pair) {
                         if (collide(pair, workspace).hit == Answer::yes) return;
                         misses.all.push_back(time_repeated([&] {
                             if (may_meet(a, b)) static_cast<void>(collide(pair, workspace));
                         }));
                         if (!may_meet(a, b)) return;
                         misses.asked.push_back(misses.all.back());
                         time_hulls(pair, misses.asked.back(), misses);
                     });
    std::printf("\nmisses %zu, apart by root boxes %zu; median us: all %.3f, the others %.3f\n",
                misses.all.size(), misses.all.size() - misses.asked.size(), median(misses.all),
                median(misses.asked));
    if (misses.hulls.empty()) return;
    std::printf(
        "hulls of the others: %zu of %zu apart, median us %.3f; hulls first take %.2f of the "
        "walks' time\n",
        misses.apart, misses.hulls.size(), median(misses.hulls), misses.hulls_first / misses.walks);
}

#ifdef CDPREP_HAVE_FCL
/// What FCL's callback knows of the search.
struct FclSearch {
    double tolerance;
    bool is_bounded;  ///< a search for a distance ends beyond the tolerance
    Clashes clashes;

    static std::uint32_t number(const fcl::CollisionObjectd* object) {
        return *static_cast<const std::uint32_t*>(object->getUserData());
    }
    static bool call(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* search,
                     double& nearer_than) {
        auto& self = *static_cast<FclSearch*>(search);
        // The manager skips boxes that are not nearer than this.
        nearer_than = std::nextafter(self.tolerance, 2 * self.tolerance);
        ++self.clashes.asked;
        fcl::DistanceResultd result;
        if (self.is_bounded) result.min_distance = nearer_than;
        fcl::distance(a, b, fcl::DistanceRequestd(), result);
        if (result.min_distance <= self.tolerance) {
            const std::uint32_t first = number(a), second = number(b);
            self.clashes.found.push_back({std::min(first, second), std::max(first, second)});
        }
        return false;
    }
};

class FclClashes {
public:
    explicit FclClashes(const std::vector<Model>& models) {
        for (const Model& model : models) {
            shapes_.push_back(
                std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>(fcl_model<fcl::OBBRSSd>(model)));
            shapes_.back()->computeLocalAABB();
        }
    }
    Clashes find(const Still& still, bool is_bounded) {
        std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
        std::vector<fcl::CollisionObjectd*> pointers;
        std::vector<std::uint32_t> numbers(still.poses.size());
        for (std::size_t i = 0; i < still.poses.size(); ++i) {
            numbers[i] = static_cast<std::uint32_t>(i);
            objects.push_back(std::make_unique<fcl::CollisionObjectd>(
                shapes_[i % shapes_.size()], fcl_transform(still.poses[i])));
            objects.back()->setUserData(&numbers[i]);
            objects.back()->computeAABB();
            pointers.push_back(objects.back().get());
        }
        fcl::DynamicAABBTreeCollisionManagerd manager;
        manager.registerObjects(pointers);
        manager.setup();
        FclSearch search{still.tolerance, is_bounded, {}};
        manager.distance(&search, FclSearch::call);
        std::sort(search.clashes.found.begin(), search.clashes.found.end());
        return search.clashes;
    }

private:
    std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes_;
};
#endif

void compare_clashes(const Still& still, int rounds) {
    Workspace workspace;
    using Find = std::function<Clashes()>;
    std::vector<std::pair<const char*, Find>> contenders;
    contenders.emplace_back("cdprep_within", [&] {
        return our_clashes(
            still, [&](const Pair& pair) { return within(pair, still.tolerance, workspace); });
    });
    contenders.emplace_back("cdprep_distance", [&] {
        return our_clashes(still, [&](const Pair& pair) {
            return distance(pair, workspace, {.max_distance = still.tolerance}).has_value();
        });
    });
#ifdef CDPREP_HAVE_FCL
    FclClashes fcl(still.models);
    contenders.emplace_back("fcl_distance", [&] { return fcl.find(still, false); });
    contenders.emplace_back("fcl_bounded", [&] { return fcl.find(still, true); });
#endif
    std::vector<std::vector<double>> ms(contenders.size());
    std::vector<Clashes> clashes(contenders.size());
    for (int round = -1; round < rounds; ++round) {  // the first is not counted
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            const double begun = thread_us();
            clashes[i] = contenders[i].second();
            if (round >= 0) ms[i].push_back((thread_us() - begun) / 1000);
            if (clashes[i].found != clashes[0].found) {
                stop(std::string(contenders[i].first) + " finds other pairs.");
            }
        }
    }
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const double middle = median(ms[i]);
        std::printf("%g,%s,%zu,%llu,%zu,%.3f,%.3f,%.3f,%.2f,%.2f\n", still.tolerance,
                    contenders[i].first, still.poses.size(),
                    static_cast<unsigned long long>(clashes[i].asked), clashes[i].found.size(),
                    middle, median(ms[i], 0.95),
                    1000 * middle / static_cast<double>(clashes[i].asked), middle / median(ms[0]),
                    middle / median(ms[1]));
    }
    std::fflush(stdout);
}

void run(std::size_t bodies, int frames, const std::vector<std::string>& paths) {
    std::vector<Model> models, whole;
    bool is_whole = false;
    for (const std::string& path : paths) {
        if (path == "all") {
            is_whole = true;
        } else {
            (is_whole ? whole : models).push_back(open_or_stop(path));
        }
    }
    std::printf("effect,contender,bodies,candidates,found,ms,ms_95,us_candidate,times\n");
    compare(models, whole, bodies, frames, {.effects = Ask::collide});
    compare(models, whole, bodies, frames, {.effects = Ask::within, .tolerance = kTolerance});
    compare(models, whole, bodies, frames, {.effects = Ask::distance, .max_distance = kTolerance});
    const Bodies still(bodies, 1);
    time_misses({whole.empty() ? models : whole, still.poses(), 0});
    std::printf(
        "\ntolerance,contender,bodies,asked,found,ms,ms_95,us_pair,times_within,"
        "times_distance\n");
    for (const double tolerance : {kShareOfScene * diagonal(models, still.poses()), kTolerance}) {
        compare_clashes({models, still.poses(), tolerance}, std::max(3, frames / 8));
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 4) cdprep::stop("Usage: scene_bench BODIES FRAMES MODEL... [all MODEL...]");
    cdprep::run(std::strtoull(arguments[1], nullptr, 10), std::atoi(arguments[2]),
                {arguments + 3, arguments + count});
}
