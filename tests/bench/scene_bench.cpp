// SPDX-License-Identifier: MIT
// A scene of many scans that all move a little each frame: which collide, which are near, how far
// apart they are.
//
// Beside it, if found at configure time: FCL's dynamic tree over the same objects, with its
// oriented boxes and spheres (OBBRSS) inside. The numbers of pairs found are printed: they must
// agree.
//
// Usage: scene_bench BODIES FRAMES MODEL...
// Models are bakes with --effects collide,within,distance, normalised to a diagonal of 1. Body i is
// of model i mod the number of models.
//
// Prints a CSV table: milliseconds of the thread's time for each frame, poses included, and for
// each candidate microseconds. `times` is relative to ours.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench_input.h"
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

void compare(const std::vector<Model>& models, std::size_t bodies, int frames,
             const LayerPair& pair) {
    Bodies start(bodies, 1);
    std::vector<std::pair<const char*, std::unique_ptr<Contender>>> contenders;
    contenders.emplace_back("cdprep", std::make_unique<Ours>(models, start.poses(), pair));
#ifdef CDPREP_HAVE_FCL
    if (pair.effects == Ask::collide) {
        contenders.emplace_back("fcl_obbrss", std::make_unique<Fcl>(models, start.poses()));
    }
#endif
    std::vector<double> ours;
    for (auto& [name, contender] : contenders) {
        Bodies moving(bodies, 1);
        std::vector<double> ms;
        std::size_t pairs = 0;
        constexpr int kWarm = 3;
        for (int frame = -kWarm; frame < frames; ++frame) {
            moving.step();
            const double begun = thread_us();
            pairs = contender->frame(moving.poses());
            if (frame >= 0) ms.push_back((thread_us() - begun) / 1000);
        }
        if (ours.empty()) ours = ms;
        const double middle = median(ms);
        const auto candidates = static_cast<double>(contenders[0].second->candidates());
        std::printf("%s,%s,%zu,%.0f,%zu,%.3f,%.3f,%.3f,%.2f\n", find_needs(pair.effects)->name,
                    name, bodies, candidates, pairs, middle, median(ms, 0.95),
                    1000 * middle / candidates, middle / median(ours));
        std::fflush(stdout);
    }
}

void run(std::size_t bodies, int frames, const std::vector<std::string>& paths) {
    std::vector<Model> models;
    for (const std::string& path : paths) models.push_back(open_or_stop(path));
    std::printf("effect,contender,bodies,candidates,found,ms,ms_95,us_candidate,times\n");
    compare(models, bodies, frames, {.effects = Ask::collide});
    compare(models, bodies, frames, {.effects = Ask::within, .tolerance = kTolerance});
    compare(models, bodies, frames, {.effects = Ask::distance, .max_distance = kTolerance});
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 4) cdprep::stop("Usage: scene_bench BODIES FRAMES MODEL...");
    cdprep::run(std::strtoull(arguments[1], nullptr, 10), std::atoi(arguments[2]),
                {arguments + 3, arguments + count});
}
