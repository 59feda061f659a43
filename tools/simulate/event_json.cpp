// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/event_json.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "scene_file/effect_words.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

const char* reason_name(EventReason reason) {
    switch (reason) {
        case EventReason::moved:
            return "moved";
        case EventReason::removed:
            return "removed";
        case EventReason::relayered:
            return "relayered";
        case EventReason::paused:
            return "paused";
        case EventReason::unchanged:
            break;
    }
    return "unchanged";
}

const char* kind_name(EventKind kind) {
    if (kind == EventKind::stays) return "stays";
    return kind == EventKind::begins ? "begins" : "ends";
}

std::tuple<std::uint32_t, std::uint32_t> slots_of(const SceneSelfOverlaps& found) {
    return {found.object.slot, found.object.slot};
}
template <class Result>
std::tuple<std::uint32_t, std::uint32_t> slots_of(const Result& found) {
    return {found.a.slot, found.b.slot};
}

/// Returns the result of the objects of an event, or null.
template <class Result>
const Result* find_result(std::span<const Result> all, const SceneEvent& event) {
    const auto slots = [](const auto& found) { return slots_of(found); };
    const auto at =
        std::lower_bound(all.begin(), all.end(), event,
                         [&](const Result& x, const SceneEvent& y) { return slots(x) < slots(y); });
    return at != all.end() && slots(*at) == slots(event) ? &*at : nullptr;
}

const char* kind_name(ImpactKind kind) {
    switch (kind) {
        case ImpactKind::none:
            return "none";
        case ImpactKind::touching:
            return "touching";
        case ImpactKind::near:
            return "near";
        case ImpactKind::unfinished:
            break;
    }
    return "unfinished";
}

const char* kind_name(scenes::BodyEventKind kind) {
    if (kind == scenes::BodyEventKind::impact) return "impact";
    return kind == scenes::BodyEventKind::sleeps ? "sleeps" : "wakes";
}

/// Adds bounds. JSON has no infinity, so an upper one is left out.
void add_bounds(Json& json, double lower, double upper) {
    json["lower"] = lower;
    if (std::isfinite(upper)) json["upper"] = upper;
}

/// Adds what an effect that holds has found.
void add_result(Json& json, const Scene& scene, const SceneEvent& event) {
    if (event.effect == Ask::distance) {
        if (const auto* found = find_result(scene.distances(), event)) {
            add_bounds(json, found->distance.lower, found->distance.upper);
        }
    } else if (event.effect == Ask::overlap) {
        const auto* found = find_result(scene.overlaps(), event);
        if (found) json["triangle_pairs"] = found->triangles.size();
    } else if (event.effect == Ask::self) {
        const auto* found = find_result(scene.self_overlaps(), event);
        if (found) json["triangle_pairs"] = found->triangles.size();
    } else if (event.effect == Ask::continuous) {
        if (const auto* found = find_result(scene.impacts(), event)) {
            json["kind"] = kind_name(found->impact.kind);
            add_bounds(json, found->impact.lower, found->impact.upper);
        }
    } else if (event.effect == Ask::haptic) {
        if (const auto* found = find_result(scene.bounded_distances(), event)) {
            json["late"] = !found->distance.is_complete;
            add_bounds(json, found->distance.lower, found->distance.upper);
        }
    } else if (event.effect == Ask::contacts) {
        if (const auto* found = find_result(scene.contacts(), event)) {
            json["contacts"] = found->contacts.size();
            add_bounds(json, found->contacts.front().lower, found->contacts.front().upper);
        }
    }
}

}  // namespace

Json event_json(std::uint64_t frame, double time_s, const SceneEvent& event,
                const scenes::Simulation& simulation) {
    Json json = {{"frame", frame},
                 {"time_s", time_s},
                 {"event", kind_name(event.kind)},
                 {"effect", scenes::effect_name(event.effect)},
                 {"a", simulation.object(event.a).name},
                 {"b", simulation.object(event.b).name},
                 {"reason", reason_name(event.reason)}};
    if (event.kind != EventKind::ends) add_result(json, simulation.scene(), event);
    return json;
}

Json push_event_json(std::uint64_t frame, double time_s, const scenes::PushEvent& event,
                     const scenes::SceneFile& scene) {
    return {{"frame", frame},
            {"time_s", time_s},
            {"event", kind_name(event.kind)},
            {"effect", scenes::effect_name(Ask::response)},
            {"a", scene.objects[event.pair.a].name},
            {"b", scene.objects[event.pair.b].name}};
}

Json body_event_json(std::uint64_t frame, double time_s, const scenes::BodyEvent& event,
                     const scenes::SceneFile& scene) {
    Json json = {{"frame", frame},
                 {"time_s", time_s},
                 {"event", kind_name(event.kind)},
                 {"effect", scenes::effect_name(Ask::response)},
                 {"body", scene.objects[event.body].name}};
    if (event.kind == scenes::BodyEventKind::impact) {
        json["other"] = scene.objects[event.other].name;
        json["impact_s"] = event.time_s;
    }
    return json;
}

}  // namespace cdprep::report
