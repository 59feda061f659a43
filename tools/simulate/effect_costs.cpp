// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/effect_costs.h"

#include <algorithm>
#include <cstddef>

#include "scene_file/compile_scene.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

/// A scene file, and the time of all its frames in each round.
struct Variant {
    SceneFile file;
    std::vector<double> seconds = {};
};

Ask effects_of(const SceneFile& file) {
    Ask all = Ask::nothing;
    for (const AskedPair& pair : file.pairs) all = all | pair.asked.effects;
    return all;
}

struct Runs {
    std::uint64_t done = 0;
    std::uint64_t all = 0;
};

/// The poses of the bodies in each frame.
using BodyPath = std::vector<std::vector<GivenPose>>;

/// Measures one run. A scene without `response` gets the poses of the bodies from `path`. A scene
/// with it writes them there, the same ones in each run.
Result<double> time_of_frames(const SceneFile& file, std::span<const SceneModel> models,
                              const CostOptions& options, const Runs& runs, BodyPath& path) {
    auto simulation = Simulation::make(file, models, options.threads, options.parallel_for);
    if (!simulation) return simulation.error();
    const Response* response = simulation->response();
    double seconds = 0;
    for (std::uint64_t frame = 0; frame < options.frames; ++frame) {
        const Result<Done> begins =
            options.begins(runs.done * options.frames + frame, runs.all * options.frames);
        if (!begins) return begins.error();
        std::span<const GivenPose> given;
        if (response == nullptr && frame < path.size()) given = path[frame];
        if (const Result<Done> done = simulation->step(frame, given); !done) return done.error();
        seconds += simulation->frame_seconds();
        if (response == nullptr || frame < path.size()) continue;
        path.emplace_back(response->poses().begin(), response->poses().end());
    }
    return seconds;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

report::EffectCost cost_of(Ask effect, const Variant& whole, const Variant& without_it) {
    std::vector<double> changes;
    for (std::size_t round = 0; round < whole.seconds.size(); ++round) {
        const double all = whole.seconds[round];
        changes.push_back(all > 0 ? without_it.seconds[round] / all - 1 : 0);
    }
    const auto [least, most] = std::minmax_element(changes.begin(), changes.end());
    return {effect, median(changes), *most - *least};
}

}  // namespace

Result<Done> check_cost_room(const SceneFile& file, std::uint64_t frames) {
    constexpr double kMost = 1e9;  // bytes
    const auto bodies = std::ranges::count_if(
        file.objects, [](const FileObject& object) { return object.body != kNoBody; });
    const double bytes = static_cast<double>(frames) * static_cast<double>(bodies) *
                         static_cast<double>(sizeof(GivenPose));
    if (bytes <= kMost) return Done{};
    return Error{ErrorCode::over_budget,
                 file.name + ": --cost would keep " + report::number_text(bytes) +
                     " bytes of poses; at most " + report::number_text(kMost) +
                     " are supported. Compute fewer frames."};
}

Result<std::vector<report::EffectCost>> measure_costs(const SceneFile& file,
                                                      std::span<const SceneModel> models,
                                                      const CostOptions& options) {
    std::vector<Variant> variants = {{file}};
    std::vector<Ask> effects;
    for (const Ask effect : report::kSimulatedEffects) {
        if (!contains(effects_of(file), effect)) continue;
        effects.push_back(effect);
        variants.push_back({file});
        drop_effect(variants.back().file, effect);
    }
    BodyPath path;
    const std::uint64_t all = options.rounds * variants.size();
    for (std::uint64_t run = 0; run < all; ++run) {
        const std::size_t place = run % variants.size();
        const bool is_backwards = run / variants.size() % 2 == 1;
        Variant& variant = variants[is_backwards ? variants.size() - 1 - place : place];
        const Result<double> seconds =
            time_of_frames(variant.file, models, options, {run, all}, path);
        if (!seconds) return seconds.error();
        variant.seconds.push_back(*seconds);
    }
    std::vector<report::EffectCost> costs;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        costs.push_back(cost_of(effects[i], variants[0], variants[i + 1]));
    }
    return costs;
}

}  // namespace cdprep::scenes
