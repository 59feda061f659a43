// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/accuracy.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "accuracy/bounding_shapes.h"
#include "accuracy/ladders.h"
#include "cdprep/pairs.h"

namespace cdprep::study {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kPosesAStratum = 50;
constexpr std::size_t kQuickPosesAStratum = 12;

/// A step, by its first words, and its approximate share of the time relative to the others.
struct Weight {
    std::string_view step;
    double full;
    double quick;
};
constexpr std::array<Weight, 18> kWeights = {{
    {"models", 1, 1},
    {"poses", 3, 0.8},
    {"self-check", 1, 0.3},
    {"shapes", 1, 0.3},
    {"2 parts", 0.5, 0.5},
    {"4 parts", 0.8, 0},
    {"8 parts", 1, 1},
    {"16 parts", 2, 0},
    {"32 parts", 4, 0},
    {"64 parts", 7, 0},
    {"128 parts", 0.1, 0},
    {"256 parts", 0.1, 0},
    {"tetra-tree", 3, 1},
    {"octree", 3, 0.5},
    {"geometry: queries", 14, 1},
    {"distance: queries", 5, 0.5},
    {"predicates: queries", 3, 0.4},
    {"coherence: queries", 8, 0.5},
}};
constexpr Weight kStorage = {"storage", 8, 1};

double weight_of(const Weight& weight, bool is_quick) {
    return is_quick ? weight.quick : weight.full;
}

/// Computes the completed share of the work from the steps that begin.
class Steps {
public:
    explicit Steps(const AccuracyOptions& options) : options_(options) {
        for (const Weight& weight : kWeights) all_ += weight_of(weight, options.is_quick);
        all_ += weight_of(kStorage, options.is_quick);
    }

    void begin(const std::string& step) {
        const auto starts = [&](const Weight& weight) { return step.starts_with(weight.step); };
        const auto* const known = std::ranges::find_if(kWeights, starts);
        double weight = weight_of(known == kWeights.end() ? kStorage : *known, options_.is_quick);
        // These begin several times, once for each level or way.
        if (step.starts_with("tetra") || step.starts_with("octree") || step.starts_with("storage"))
            weight /= 7;
        done_ = std::min(all_, done_ + weight_);
        weight_ = weight;
        step_ = step;
        step_begun_ = told_ = Clock::now();
        if (options_.progress) options_.progress(done_ / all_, step_);
    }

    /// Reports once a second the estimated progress of a long step, from the time of earlier steps.
    void tick() {
        const Clock::time_point now = Clock::now();
        if (!options_.progress || done_ <= 0 || now - told_ < std::chrono::seconds(1)) return;
        told_ = now;
        const std::chrono::duration<double> before = step_begun_ - begun_;
        const std::chrono::duration<double> within = now - step_begun_;
        const double expected = before.count() / done_ * weight_;
        const double share = expected > 0 ? std::min(kMostOfAStep, within.count() / expected) : 0;
        options_.progress((done_ + share * weight_) / all_, step_);
    }

private:
    static constexpr double kMostOfAStep = 0.95;

    const AccuracyOptions& options_;
    double all_ = 0;
    double done_ = 0;
    double weight_ = 0;
    std::string step_;
    Clock::time_point begun_ = Clock::now();
    Clock::time_point step_begun_ = begun_;
    Clock::time_point told_ = begun_;
};

StudiedModel describe(const mesh::Mesh& mesh, const MemoryModel& model) {
    const BoundingBox box = aligned_box(mesh);
    return {mesh.triangles.size(), mesh.positions.size(),
            2 * std::hypot(box.half.x, box.half.y, box.half.z), model.model.is_balanced(),
            mesh.single_precision};
}

/// Returns the time ratio of the exact query to itself, which shows the resolution of the clock.
TimeRatio check_clock(const Climb& climb) {
    Workspace workspace;
    const Question exact = question_of([&](std::size_t i) {
        return collide(
                   {climb.a.model, climb.b.model, Placement::b_moves(climb.set.poses[i].a_from_b)},
                   workspace)
                           .hit == Answer::yes
                   ? 1
                   : 0;
    });
    TimingOptions timing = climb.timing;
    timing.rounds = 9;
    return ratio_to_itself(climb.set.poses.size(), exact, timing);
}

Error stopped() {
    return {ErrorCode::interrupted, "The study was stopped; nothing was written."};
}

/// One study of a pair of models.
class AccuracyRun {
public:
    AccuracyRun(const mesh::Mesh& a, const mesh::Mesh& b, const AccuracyOptions& options)
        : a_(a), b_(b), options_(options), steps_(options) {}

    Result<AccuracyStudy> run() {
        steps_.begin("models");
        const MemoryParts parts = {.hulls = true};
        const Result<MemoryModel> model_a = make_memory_model(a_, parts, options_.parallel_for);
        if (!model_a) return model_a.error();
        const Result<MemoryModel> model_b = make_memory_model(b_, parts, options_.parallel_for);
        if (!model_b) return model_b.error();
        if (must_stop()) return stopped();

        study_.machine = describe_machine();
        study_.is_quick = options_.is_quick;
        study_.a = describe(a_, model_a.value());
        study_.b = describe(b_, model_b.value());
        study_.timing = timing_options();
        if (const auto error = find_poses({model_a->model, model_b->model})) return *error;
        climb({a_, b_, model_a.value(), model_b.value(), study_.set, study_.timing,
               options_.is_quick, options_.parallel_for, options_.stop,
               [this](const std::string& step) { steps_.begin(step); }});
        if (must_stop()) return stopped();
        study_.timing.stop = {};  // it refers to this object
        study_.seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
        return std::move(study_);
    }

private:
    struct Models {
        const Model& a;
        const Model& b;
    };

    [[nodiscard]] bool must_stop() const {
        return options_.stop && options_.stop();
    }

    TimingOptions timing_options() {
        TimingOptions timing;
        timing.rounds = options_.is_quick ? 3 : 5;
        timing.least_sample_s = options_.is_quick ? 10e-6 : 50e-6;
        timing.budget_s = options_.is_quick ? 1 : 25;
        timing.stop = [this] {
            steps_.tick();
            return must_stop();
        };
        return timing;
    }

    std::optional<Error> find_poses(const Models& models) {
        steps_.begin("poses");
        study_.set =
            make_pose_set(models.a, models.b,
                          {.seed = options_.seed,
                           .per_stratum = options_.is_quick ? kQuickPosesAStratum : kPosesAStratum,
                           .parallel_for = options_.parallel_for,
                           .stop = options_.stop});
        if (must_stop()) return stopped();
        if (study_.set.poses.empty()) {
            return Error{ErrorCode::bad_argument,
                         "No poses were found at which the models come near each other. Check that "
                         "they have an extent, and no coordinates near 2^1000 (1e301)."};
        }
        study_.rigid = static_cast<std::size_t>(
            std::ranges::count_if(study_.set.poses, [](const StudyPose& p) { return p.is_rigid; }));
        return std::nullopt;
    }

    void climb(const Climb& climb) {
        steps_.begin("self-check");
        study_.self = check_clock(climb);
        if (is_wanted("geometry")) study_.ladders.push_back(climb_geometry(climb, study_.broken));
        if (is_wanted("distance")) study_.ladders.push_back(climb_distance(climb, study_.broken));
        if (is_wanted("predicates")) {
            study_.ladders.push_back(climb_predicates(climb, study_.broken));
        }
        if (is_wanted("storage")) study_.ladders.push_back(climb_storage(climb, study_.broken));
        if (is_wanted("coherence")) {
            study_.ladders.push_back(
                climb_coherence(climb, study_.machine.last_cache, study_.broken));
        }
    }

    [[nodiscard]] bool is_wanted(const char* ladder) const {
        return !must_stop() &&
               (options_.ladders.empty() || std::ranges::count(options_.ladders, ladder) > 0);
    }

    const Clock::time_point begun_ = Clock::now();
    const mesh::Mesh& a_;
    const mesh::Mesh& b_;
    const AccuracyOptions& options_;
    Steps steps_;
    AccuracyStudy study_;
};

}  // namespace

Result<AccuracyStudy> study_accuracy(const mesh::Mesh& a, const mesh::Mesh& b,
                                     const AccuracyOptions& options) {
    if (a.triangles.empty() || b.triangles.empty()) {
        return Error{ErrorCode::bad_argument,
                     std::string(a.triangles.empty() ? "The first" : "The second") +
                         " model has no triangles, so it cannot be queried."};
    }
    return AccuracyRun(a, b, options).run();
}

}  // namespace cdprep::study
