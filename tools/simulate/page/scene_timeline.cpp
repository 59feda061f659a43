// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/page/scene_timeline.h"

#include <algorithm>
#include <utility>

namespace cdprep::report {
namespace {

/// Returns what happened in one frame.
TimelineSpan span_of(const scenes::Simulation& simulation) {
    TimelineSpan span;
    span.frames = 1;
    span.longest = simulation.frame_seconds();
    for (const SceneHit& hit : simulation.scene().hits()) {
        for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
            if (contains(hit.holds, kSceneEffects[i])) ++span.holds[i];
        }
    }
    if (const scenes::Response* response = simulation.response()) {
        span.holds.back() = response->pushing().size();
        for (const scenes::PushEvent& event : response->push_events()) {
            if (event.kind == EventKind::begins) ++span.begins.back();
            if (event.kind == EventKind::ends) ++span.ends.back();
        }
    }
    for (const SceneEvent& event : simulation.scene().events()) {
        const std::size_t effect = effect_number(event.effect);
        if (event.kind == EventKind::begins) ++span.begins[effect];
        if (event.kind == EventKind::ends) ++span.ends[effect];
    }
    return span;
}

void add_span(TimelineSpan& sum, const TimelineSpan& next) {
    sum.frames += next.frames;
    sum.longest = std::max(sum.longest, next.longest);
    for (std::size_t i = 0; i < sum.holds.size(); ++i) {
        sum.begins[i] += next.begins[i];
        sum.ends[i] += next.ends[i];
        sum.holds[i] = std::max(sum.holds[i], next.holds[i]);
    }
    for (std::size_t i = 0; i < sum.seconds.size(); ++i) sum.seconds[i] += next.seconds[i];
}

}  // namespace

std::vector<StageTime> stage_times(const scenes::Simulation& simulation) {
    const SceneCounts& counts = simulation.scene().counts();
    const auto seconds = [](std::uint64_t nanoseconds) {
        return 1e-9 * static_cast<double>(nanoseconds);
    };
    const std::size_t threads = simulation.thread_count();
    std::vector<StageTime> times;
    if (simulation.response() != nullptr) {
        times.push_back({"response", simulation.response_seconds()});
    }
    if (!simulation.changing().empty()) {
        times.push_back({"model changes", simulation.change_work().seconds});
    }
    times.push_back({"boxes", seconds(counts.box_ticks)});
    for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
        if (!contains(simulation.plan().effects(), kSceneEffects[i])) continue;
        times.push_back(
            {scenes::effect_name(kSceneEffects[i]), seconds(counts.ticks[i] / threads)});
    }
    times.push_back({"pair overhead", seconds(rest_of_pairs(counts, threads))});
    times.push_back({"lists", seconds(counts.list_ticks)});
    return times;
}

void SceneTimeline::add(const scenes::Simulation& simulation) {
    const std::vector<StageTime> times = stage_times(simulation);
    if (stages_.empty()) {
        for (const StageTime& stage : times) stages_.push_back(stage.stage);
    }
    TimelineSpan span = span_of(simulation);
    for (const StageTime& stage : times) span.seconds.push_back(stage.seconds);
    if (!spans_.empty() && spans_.back().frames < frames_per_span_) {
        add_span(spans_.back(), span);
        return;
    }
    if (spans_.size() == kMostSpans) join_spans();
    spans_.push_back(std::move(span));
}

/// Makes one span of two neighbours. All spans are full when it is called.
void SceneTimeline::join_spans() {
    for (std::size_t i = 0; 2 * i < spans_.size(); ++i) {
        TimelineSpan joined = std::move(spans_[2 * i]);
        add_span(joined, spans_[2 * i + 1]);
        spans_[i] = std::move(joined);
    }
    spans_.resize(spans_.size() / 2);
    frames_per_span_ *= 2;
}

}  // namespace cdprep::report
