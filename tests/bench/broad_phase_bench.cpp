// SPDX-License-Identifier: MIT
// Pairs of boxes that meet, as they move: one update of all boxes that moved, and all pairs.
//
// Beside it, if found at configure time: Bullet's trees of boxes and its sweep and prune, FCL's
// dynamic tree, ODE's sweep and prune, CGAL's box intersection. Bullet keeps larger boxes, so its
// pairs are tested once more.
//
// Usage: broad_phase_bench COUNT STEPS ROUNDS [SCENE...]
// Prints the median, the 95th percentile and the mean of a step in milliseconds of the thread's
// time, and the median and the mean relative to ours. Trees that are mended now and then have a
// mean far above their median. Pairs are of all steps; `others` are how many more, or fewer, a peer
// counts. FCL and ODE round boxes. Bullet's sweep and prune loses pairs where few boxes move.
//
// A second table has the fastest peer of each scene that loses no pair, by its median, relative to
// ours, and our 95th percentile relative to our median, with what is asked of both.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/broad_phase.h"
#include "support/moving_boxes.h"

#ifdef CDPREP_HAVE_BULLET
#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#endif
#ifdef CDPREP_HAVE_FCL
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#endif
#ifdef CDPREP_HAVE_ODE
#include <ode/ode.h>
#endif
#ifdef CDPREP_HAVE_CGAL
#include <CGAL/box_intersection_d.h>
#endif

namespace cdprep {
namespace {

using Boxes = std::span<const WorldBox>;
using Moved = std::span<const std::uint32_t>;

class Contender {
public:
    virtual ~Contender() = default;
    /// Takes the boxes that moved. Returns the number of pairs that meet.
    virtual std::size_t step(Boxes boxes, Moved moved) = 0;
};

class Ours final : public Contender {
public:
    explicit Ours(Boxes boxes)
        : broad_phase_({.boxes = static_cast<std::uint32_t>(boxes.size()),
                        .pairs = static_cast<std::uint32_t>(16 * boxes.size())}) {
        if (!broad_phase_.update(boxes).complete) stop("There is too little room for pairs.");
    }
    std::size_t step(Boxes boxes, Moved moved) override {
        return broad_phase_.update_moved(boxes, {}, moved).pairs.size();
    }

private:
    BroadPhase broad_phase_;
};

#ifdef CDPREP_HAVE_BULLET
template <class Phase>
class Bullet final : public Contender {
public:
    template <class... Arguments>
    explicit Bullet(Boxes boxes, Arguments... arguments)
        : dispatcher_(&configuration_), phase_(arguments...) {
        for (const WorldBox& box : boxes) {
            proxies_.push_back(
                phase_.createProxy(lower(box), upper(box), 0, nullptr, 1, -1, &dispatcher_));
        }
        phase_.calculateOverlappingPairs(&dispatcher_);
    }
    ~Bullet() override {
        for (btBroadphaseProxy* proxy : proxies_) phase_.destroyProxy(proxy, &dispatcher_);
    }
    std::size_t step(Boxes boxes, Moved moved) override {
        for (const std::uint32_t i : moved) {
            phase_.setAabb(proxies_[i], lower(boxes[i]), upper(boxes[i]), &dispatcher_);
        }
        phase_.calculateOverlappingPairs(&dispatcher_);
        const btBroadphasePairArray& pairs =
            phase_.getOverlappingPairCache()->getOverlappingPairArray();
        std::size_t count = 0;
        for (int i = 0; i < pairs.size(); ++i) {
            const btBroadphaseProxy &a = *pairs[i].m_pProxy0, &b = *pairs[i].m_pProxy1;
            count += TestAabbAgainstAabb2(a.m_aabbMin, a.m_aabbMax, b.m_aabbMin, b.m_aabbMax);
        }
        return count;
    }

private:
    static btVector3 lower(const WorldBox& box) {
        return {box.lower[0], box.lower[1], box.lower[2]};
    }
    static btVector3 upper(const WorldBox& box) {
        return {box.upper[0], box.upper[1], box.upper[2]};
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    Phase phase_;
    std::vector<btBroadphaseProxy*> proxies_;
};
#endif

#ifdef CDPREP_HAVE_FCL
class Fcl final : public Contender {
public:
    explicit Fcl(Boxes boxes) {
        for (const WorldBox& box : boxes) {
            const fcl::Vector3d size = upper(box) - lower(box);
            objects_.push_back(std::make_unique<fcl::CollisionObjectd>(
                std::make_shared<fcl::Boxd>(size[0], size[1], size[2])));
            place(*objects_.back(), box);
            manager_.registerObject(objects_.back().get());
        }
        manager_.setup();
    }
    std::size_t step(Boxes boxes, Moved moved) override {
        std::vector<fcl::CollisionObjectd*> changed;
        for (const std::uint32_t i : moved) {
            place(*objects_[i], boxes[i]);
            changed.push_back(objects_[i].get());
        }
        manager_.update(changed);
        std::size_t count = 0;
        manager_.collide(
            &count, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* counter) {
                *static_cast<std::size_t*>(counter) += a->getAABB().overlap(b->getAABB());
                return false;
            });
        return count;
    }

private:
    static fcl::Vector3d lower(const WorldBox& box) {
        return {box.lower[0], box.lower[1], box.lower[2]};
    }
    static fcl::Vector3d upper(const WorldBox& box) {
        return {box.upper[0], box.upper[1], box.upper[2]};
    }
    static void place(fcl::CollisionObjectd& object, const WorldBox& box) {
        object.setTranslation((lower(box) + upper(box)) / 2);
        object.computeAABB();
    }

    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
    fcl::DynamicAABBTreeCollisionManagerd manager_;
};
#endif

#ifdef CDPREP_HAVE_ODE
class Ode final : public Contender {
public:
    explicit Ode(Boxes boxes) {
        dInitODE2(0);
        space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
        for (const WorldBox& box : boxes) {
            geoms_.push_back(dCreateBox(space_, at(box, 0, -1), at(box, 1, -1), at(box, 2, -1)));
            place(geoms_.back(), box);
        }
    }
    ~Ode() override {
        dSpaceDestroy(space_);
        dCloseODE();
    }
    std::size_t step(Boxes boxes, Moved moved) override {
        for (const std::uint32_t i : moved) place(geoms_[i], boxes[i]);
        std::size_t count = 0;
        dSpaceCollide(space_, &count, [](void* counter, dGeomID a, dGeomID b) {
            dReal x[6], y[6];
            dGeomGetAABB(a, x);
            dGeomGetAABB(b, y);
            *static_cast<std::size_t*>(counter) += x[0] <= y[1] && y[0] <= x[1] && x[2] <= y[3] &&
                                                   y[2] <= x[3] && x[4] <= y[5] && y[4] <= x[5];
        });
        return count;
    }

private:
    /// The middle along an axis with a sign of 1, the edge with -1.
    static dReal at(const WorldBox& box, std::size_t axis, int sign) {
        const dReal lower = box.lower[axis], upper = box.upper[axis];
        return sign > 0 ? (lower + upper) / 2 : upper - lower;
    }
    static void place(dGeomID geom, const WorldBox& box) {
        dGeomSetPosition(geom, at(box, 0, 1), at(box, 1, 1), at(box, 2, 1));
    }

    dSpaceID space_;
    std::vector<dGeomID> geoms_;
};
#endif

#ifdef CDPREP_HAVE_CGAL
class Cgal final : public Contender {
public:
    explicit Cgal(Boxes /*boxes*/) {}
    std::size_t step(Boxes boxes, Moved /*moved*/) override {
        boxes_.clear();
        for (const WorldBox& box : boxes) {
            double lower[3], upper[3];
            std::copy_n(box.lower, 3, lower);
            std::copy_n(box.upper, 3, upper);
            boxes_.emplace_back(lower, upper);
        }
        std::size_t count = 0;
        CGAL::box_self_intersection_d(boxes_.begin(), boxes_.end(),
                                      [&](const Box&, const Box&) { ++count; });
        return count;
    }

private:
    using Box = CGAL::Box_intersection_d::Box_d<double, 3>;
    std::vector<Box> boxes_;
};
#endif

struct Named {
    const char* name;
    std::unique_ptr<Contender> (*make)(Boxes);
    std::size_t most;  ///< boxes; more would take minutes
};

template <class Made>
std::unique_ptr<Contender> make(Boxes boxes) {
    return std::make_unique<Made>(boxes);
}

constexpr std::size_t kAnyCount = ~std::size_t{0};

std::vector<Named> contenders() {
    std::vector<Named> all = {{"cdprep", make<Ours>, kAnyCount}};
#ifdef CDPREP_HAVE_BULLET
    all.push_back({"bullet_dbvt", make<Bullet<btDbvtBroadphase>>, kAnyCount});
    all.push_back({"bullet_sap",
                   [](Boxes boxes) -> std::unique_ptr<Contender> {
                       constexpr btScalar kWorld = 1000;
                       return std::make_unique<Bullet<bt32BitAxisSweep3>>(
                           boxes, btVector3(-kWorld, -kWorld, -kWorld),
                           btVector3(kWorld, kWorld, kWorld),
                           static_cast<unsigned>(boxes.size() + 1));
                   },
                   20'000});
#endif
#ifdef CDPREP_HAVE_FCL
    all.push_back({"fcl_tree", make<Fcl>, kAnyCount});
#endif
#ifdef CDPREP_HAVE_ODE
    all.push_back({"ode_sap", make<Ode>, kAnyCount});
#endif
#ifdef CDPREP_HAVE_CGAL
    all.push_back({"cgal", make<Cgal>, kAnyCount});
#endif
    return all;
}

struct Times {
    std::vector<double> ms;
    std::size_t pairs = 0;  ///< of all steps
};

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// How many times as fast as the fastest peer an update shall be. Less is asked where peers have
/// little to do.
double goal_of(test::BoxScene scene, std::size_t count) {
    if (count > 10'000) return 10;
    if (count > 1000) return 4;
    return scene == test::BoxScene::resting || scene == test::BoxScene::ratios ? 1.5 : 3;
}

/// Prints a row of the second table. Ours is the first.
void print_goal(test::BoxScene scene, std::size_t count, const std::vector<Named>& all,
                std::vector<Times>& times) {
    constexpr double kMostUneven = 2;
    std::size_t best = 0;
    for (std::size_t c = 1; c < all.size(); ++c) {
        constexpr double kAll = 0.999;  // but for rounding
        if (static_cast<double>(times[c].pairs) < kAll * static_cast<double>(times[0].pairs)) {
            continue;
        }
        if (best == 0 || median(times[c].ms) < median(times[best].ms)) best = c;
    }
    if (best == 0) return;
    const double middle = median(times[0].ms), goal = goal_of(scene, count);
    const double ratio = median(times[best].ms) / middle;
    const double uneven = median(times[0].ms, 0.95) / middle;
    std::printf("%s,%zu,%s,%.2f,%.1f,%s,%.2f,%.0f,%s\n", test::name_of(scene), count,
                all[best].name, ratio, goal, ratio >= goal ? "met" : "missed", uneven, kMostUneven,
                uneven <= kMostUneven ? "met" : "missed");
}

std::vector<Times> compare(test::BoxScene scene, std::size_t count, int steps, int rounds) {
    const std::vector<Named> all = contenders();
    std::vector<Times> times(all.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t c = 0; c < all.size(); ++c) {
            if (count > all[c].most) continue;
            test::MovingBoxes boxes(scene, count, 1);
            const std::unique_ptr<Contender> contender = all[c].make(boxes.boxes());
            constexpr int kWarm = 40;
            for (int step = -kWarm; step < steps; ++step) {
                boxes.step();
                const double begun = thread_us();
                const std::size_t pairs = contender->step(boxes.boxes(), boxes.moved());
                const double ms = (thread_us() - begun) / 1000;
                times[c].pairs += pairs;
                if (step >= 0) times[c].ms.push_back(ms);
            }
        }
    }
    for (std::size_t c = 0; c < all.size(); ++c) {
        if (times[c].ms.empty()) continue;
        const double middle = median(times[c].ms), mean = mean_of(times[c].ms);
        std::printf("%s,%zu,%s,%zu,%.0f,%.4f,%.4f,%.4f,%.2f,%.2f\n", test::name_of(scene), count,
                    all[c].name, times[c].pairs, double(times[c].pairs) - double(times[0].pairs),
                    middle, median(times[c].ms, 0.95), mean, middle / median(times[0].ms),
                    mean / mean_of(times[0].ms));
    }
    std::fflush(stdout);
    return times;
}

void run(std::size_t count, int steps, int rounds, const std::vector<std::string>& names) {
    std::vector<std::pair<test::BoxScene, std::vector<Times>>> asked;
    std::printf("scene,boxes,contender,pairs,others,ms,ms_95,ms_mean,times,times_mean\n");
    for (const test::BoxScene scene : test::kBoxScenes) {
        const bool is_named = std::ranges::find(names, test::name_of(scene)) != names.end();
        if (!names.empty() && !is_named) continue;
        asked.emplace_back(scene, compare(scene, count, steps, rounds));
    }
    std::printf("\nscene,boxes,best_peer,times,goal,verdict,ms_95_times,most,verdict_95\n");
    for (auto& [scene, times] : asked) print_goal(scene, count, contenders(), times);
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 4) cdprep::stop("Usage: broad_phase_bench COUNT STEPS ROUNDS [SCENE...]");
    cdprep::run(std::strtoull(arguments[1], nullptr, 10), std::atoi(arguments[2]),
                std::max(1, std::atoi(arguments[3])), {arguments + 4, arguments + count});
}
