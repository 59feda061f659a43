// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/cost_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene_file/compile_scene.h"
#include "simulate/run/section_use.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

constexpr std::size_t kResponse = kSceneEffects.size();  ///< its place in kSimulatedEffects

std::uint64_t nanoseconds_of(double seconds) {
    return static_cast<std::uint64_t>(std::llround(1e9 * seconds));
}

std::vector<std::string> asked_by(const scenes::SceneFile& scene, Ask effect) {
    std::vector<std::string> names;
    for (const scenes::AskedPair& pair : scene.pairs) {
        if (!contains(pair.asked.effects, effect)) continue;
        names.push_back(printable(scene.layers[pair.asked.a]) + "-" +
                        printable(scene.layers[pair.asked.b]));
    }
    return names;
}

/// Returns by how much the scene of a plan is larger than without an effect.
std::uint64_t state_bytes_of(const scenes::SceneFile& scene, const scenes::Simulation& simulation,
                             Ask effect) {
    const Plan& plan = simulation.plan();
    scenes::SceneFile less;
    less.layers = scene.layers;
    less.pairs = scene.pairs;
    scenes::drop_effect(less, Ask::response);
    scenes::drop_effect(less, effect);
    std::vector<std::string> names;
    const Plan::Compiled compiled = scenes::compile_scene(
        less, plan.limits(), scenes::uses_of(scene, simulation.models(), names));
    const std::size_t whole = Scene::size(plan);
    return compiled.plan ? whole - std::min(whole, Scene::size(*compiled.plan)) : 0;
}

/// Returns whether a pair of layers asks an effect through enclosing parts.
bool asks_parts(const Plan& plan, const LayerPair& pair, Ask effect) {
    if ((effect & (Ask::collide | Ask::distance)) == Ask::nothing) return false;
    const auto number = plan.find_pair(pair.a, pair.b);
    return number && plan.rungs()[*number].rung == Rung::parts;
}

/// Returns the queries of an effect of a pair of layers.
Ask asks_of(const scenes::SceneFile& scene, const Plan& plan, const LayerPair& pair, Ask effect) {
    constexpr Ask kReadsBody = Ask::collide | Ask::distance | Ask::contacts | Ask::continuous;
    if (effect == Ask::response) {
        const bool continuous =
            std::ranges::any_of(scene.bodies, &scenes::BodyMotion::is_continuous);
        const Ask bodies = Ask::contacts | Ask::response | Ask::solid;
        return continuous ? bodies | Ask::distance : bodies;
    }
    const bool solid = pair.body == Body::solid && (effect & kReadsBody) != Ask::nothing;
    const Ask asks = solid ? effect | Ask::solid : effect;
    return asks_parts(plan, pair, effect) ? asks | Ask::hulls : asks;
}

std::uint64_t read_bytes_of(const scenes::SceneFile& scene, Ask effect,
                            const scenes::Simulation& simulation) {
    std::uint64_t bytes = 0;
    for (const scenes::SceneModel& model : simulation.models()) {
        if (!model.model) continue;
        format::SectionSet sections;
        for (const scenes::AskedPair& pair : scene.pairs) {
            const std::uint32_t layers = 1U << pair.asked.a | 1U << pair.asked.b;
            if (!contains(pair.asked.effects, effect) || (model.needs.layers & layers) == 0)
                continue;
            sections.insert(sections_for(asks_of(scene, simulation.plan(), pair.asked, effect)));
        }
        bytes += bytes_of(*model.model, sections);
    }
    return bytes;
}

}  // namespace

CostTable::CostTable(const scenes::SceneFile& scene, const Plan& plan)
    : scene_(scene), plan_(plan) {}

void CostTable::add(const scenes::Simulation& simulation) {
    const SceneCounts& counts = simulation.scene().counts();
    const std::uint64_t threads = simulation.thread_count();
    counts_.moved += counts.moved;
    counts_.candidates += counts.candidates;
    counts_.kept += counts.kept;
    counts_.apart += counts.apart;
    for (std::size_t i = 0; i < counts.calls.size(); ++i) {
        counts_.calls[i] += counts.calls[i];
        counts_.ticks[i] += counts.ticks[i];
        if (contains(plan_.effects(), kSceneEffects[i])) times_[i].add(counts.ticks[i] / threads);
    }
    counts_.box_ticks += counts.box_ticks;
    counts_.query_ticks += counts.query_ticks;
    counts_.list_ticks += counts.list_ticks;
    rest_nanoseconds_ += rest_of_pairs(counts, threads);
    for (const SceneEvent& event : simulation.scene().events()) {
        const std::size_t effect = effect_number(event.effect);
        add_event(effect, event.kind);
    }
    if (simulation.response() != nullptr) add_bodies(simulation);
    change_work_.add(simulation.change_work());
    frame_times_.add(nanoseconds_of(simulation.frame_seconds()));
    refit_times_.add(nanoseconds_of(simulation.change_work().seconds));
}

void CostTable::add_event(std::size_t effect, EventKind kind) {
    begins_[effect] += kind == EventKind::begins ? 1 : 0;
    ends_[effect] += kind == EventKind::ends ? 1 : 0;
}

void CostTable::add_bodies(const scenes::Simulation& simulation) {
    const dynamics::DynamicsCounts& counts = simulation.response()->bodies().counts();
    body_counts_.pairs += counts.pairs;
    body_counts_.contacts += counts.contacts;
    body_counts_.deep += counts.deep;
    body_counts_.shortened += counts.shortened;
    body_counts_.incomplete += counts.incomplete;
    body_counts_.too_fast += counts.too_fast;
    body_counts_.impacts += counts.impacts;
    for (const scenes::PushEvent& event : simulation.response()->push_events()) {
        add_event(kResponse, event.kind);
    }
    times_[kResponse].add(nanoseconds_of(simulation.response_seconds()));
}

const TimeHistogram& CostTable::times_of(Ask effect) const noexcept {
    return effect == Ask::response ? times_[kResponse] : times_[effect_number(effect)];
}

std::vector<EffectRow> CostTable::effects(const scenes::Simulation& simulation) const {
    std::vector<EffectRow> rows;
    for (const Ask effect : kSimulatedEffects) {
        const bool is_response = effect == Ask::response;
        if (is_response ? simulation.response() == nullptr : !contains(plan_.effects(), effect)) {
            continue;
        }
        EffectRow row;
        row.effect = effect;
        row.asked_by = asked_by(scene_, effect);
        row.nanoseconds = times_of(effect).sum();
        row.p99 = times_of(effect).at(0.99);
        row.read_bytes = read_bytes_of(scene_, effect, simulation);
        const std::size_t number = is_response ? kResponse : effect_number(effect);
        row.begins = begins_[number];
        row.ends = ends_[number];
        if (is_response) {
            row.calls = body_counts_.pairs;
            row.state_bytes = simulation.response()->bodies().state_bytes();
        } else {
            row.calls = counts_.calls[number];
            row.state_bytes = state_bytes_of(scene_, simulation, effect);
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<PartRow> CostTable::parts() const {
    std::vector<PartRow> rows = {{"boxes and broad phase", counts_.box_ticks},
                                 {"pair overhead", rest_nanoseconds_},
                                 {"lists and events", counts_.list_ticks}};
    if (refit_times_.sum() > 0) rows.push_back({"model changes", refit_times_.sum()});
    return rows;
}

double CostTable::explained() const {
    const std::uint64_t all = frame_times_.sum();
    std::uint64_t rows = 0;
    for (const TimeHistogram& times : times_) rows += times.sum();
    for (const PartRow& row : parts()) rows += row.nanoseconds;
    return all > 0 ? static_cast<double>(rows) / static_cast<double>(all) : 1;
}

}  // namespace cdprep::report
