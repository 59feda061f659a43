// SPDX-License-Identifier: MIT
#include "cdprep/scene.h"

#include <algorithm>
#include <cassert>
#include <new>
#include <utility>

#include "cdprep/format/float_environment.h"
#include "cdprep/format/portable.h"
#include "core/require.h"
#include "scene/scene_state.h"

namespace cdprep {
namespace {

/// A hash of numbers, one after the other (the mixing of SplitMix64, Steele et al. 2014).
class Hash {
public:
    void add(std::uint64_t number) noexcept {
        std::uint64_t x = value_ + 0x9e3779b97f4a7c15 + number;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
        x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
        value_ = x ^ (x >> 31);
    }
    void add(std::uint32_t one, std::uint32_t two) noexcept {
        add(std::uint64_t{one} << 32 | two);
    }
    void add(double number) noexcept {
        add(format::bit_cast<std::uint64_t>(number));
    }
    void add(const ObjectId& id) noexcept {
        add(id.slot, id.generation);
    }
    void add(const Double3& point) noexcept {
        for (const double coordinate : {point.x, point.y, point.z}) add(coordinate);
    }
    void add(const Contact& contact) noexcept {
        add(contact.id);
        add(contact.piece_a, contact.piece_b);
        add(contact.flags, contact.point_count);
        for (const Double3& each : {contact.point_a, contact.point_b, contact.normal}) add(each);
        for (const double bound : {contact.lower, contact.upper}) add(bound);
        for (std::uint32_t i = 0; i < contact.point_count; ++i) {
            add(contact.points[i].id);
            add(contact.points[i].distance);
        }
    }
    [[nodiscard]] std::uint64_t value() const noexcept {
        return value_;
    }

private:
    std::uint64_t value_ = 0;
};

}  // namespace

void Scene::Release::operator()(State* state) const noexcept {
    if (state != nullptr) state->~State();
    if (owns) ::operator delete (state, std::align_val_t{kCarveAlignment});
}

Scene::Scene(std::unique_ptr<State, Release> state) noexcept : state_(std::move(state)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

namespace {

BroadPhaseLimits broad_phase_limits(const Plan& plan) noexcept {
    const SceneLimits& limits = plan.limits();
    return {.boxes = limits.objects, .pairs = limits.pairs, .threads = limits.threads};
}

}  // namespace

Scene::State* Scene::make(std::byte* memory, const Plan& plan) noexcept {
    Carver carver(memory);
    State* const room = carver.take_room<State>();
    auto* const state = new (room) State(carver, plan);
    const BroadPhaseLimits limits = broad_phase_limits(plan);
    state->broad_phase =
        BroadPhase::in_memory({memory + carver.used(), BroadPhase::size(limits)}, limits);
    assert(state->broad_phase);  // the plan has checked the limits
    const std::size_t objects = plan.limits().objects;
    for (std::uint32_t slot = 0; slot < objects; ++slot) state->place(slot);
    static_cast<void>(
        state->broad_phase->update({state->boxes, objects}, {state->filters, objects}));
    return state;
}

std::size_t Scene::size(const Plan& plan) noexcept {
    Carver carver(nullptr);
    carver.take_room<State>();
    const State measured(carver, plan);
    return saturated(std::uint64_t{carver.used()} + BroadPhase::size(broad_phase_limits(plan)));
}

std::size_t Scene::alignment() noexcept {
    return kCarveAlignment;
}

Scene::Scene(const Plan& plan)
    : state_(make(static_cast<std::byte*>(
                      ::operator new (size(plan), std::align_val_t{kCarveAlignment})),
                  plan),
             Release{true}) {}

std::optional<Scene> Scene::in_memory(std::span<std::byte> memory, const Plan& plan) noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    if (memory.size() < size(plan) || address % kCarveAlignment != 0) return std::nullopt;
    return Scene(std::unique_ptr<State, Release>(make(memory.data(), plan), Release{false}));
}

std::optional<ObjectId> Scene::add(const SceneObject& object) noexcept {
    State& state = *state_;
    if (object.model == nullptr) stop_with("An object of a scene needs a model.");
    if (object.layer >= kLayers)
        stop_with("A scene has 32 layers; the layer of an object must be 0 to 31.");
    require(*object.model, state.plan->asks_of(object.layer));
    const std::uint32_t most = state.plan->limits().objects;
    std::uint32_t& slot = state.first_free;
    while (slot < most && state.objects[slot].model != nullptr) ++slot;
    if (slot == most) return std::nullopt;
    ObjectSlot& place = state.objects[slot];
    place.model = object.model;
    place.pose = object.world_from_model;
    place.layer = place.last_layer = object.layer;
    if (state.last_poses != nullptr) state.last_poses[slot] = object.world_from_model;
    place.generation = next_generation(place.generation);
    state.find_parts(slot);
    state.change(slot);
    ++state.object_count;
    return ObjectId{slot, place.generation};
}

bool Scene::remove(ObjectId object) noexcept {
    State& state = *state_;
    ObjectSlot* const found = state.find(object);
    if (found == nullptr) return false;
    found->model = nullptr;
    state.change(object.slot);
    state.first_free = std::min(state.first_free, object.slot);
    --state.object_count;
    return true;
}

bool Scene::set_pose(ObjectId object, const Pose& world_from_model) noexcept {
    ObjectSlot* const found = state_->find(object);
    if (found == nullptr) return false;
    found->pose = world_from_model;
    state_->change(object.slot);
    return true;
}

bool Scene::put(ObjectId object, const Pose& world_from_model) noexcept {
    if (!set_pose(object, world_from_model)) return false;
    if (state_->last_poses != nullptr) state_->last_poses[object.slot] = world_from_model;
    return true;
}

bool Scene::set_layer(ObjectId object, std::uint32_t layer) noexcept {
    ObjectSlot* const found = state_->find(object);
    if (found == nullptr) return false;
    if (layer >= kLayers)
        stop_with("A scene has 32 layers; the layer of an object must be 0 to 31.");
    require(*found->model, state_->plan->asks_of(layer));
    if (found->layer == layer) return true;
    found->layer = layer;
    state_->find_parts(object.slot);
    state_->change(object.slot);
    return true;
}

void Scene::set_paused(Ask effects) noexcept {
    state_->paused = effects & state_->planned;
}

void Scene::set_clock(SceneClock clock) noexcept {
    state_->clock = clock;
}

SceneStep Scene::step(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept {
    if (workspaces.empty()) stop_with("A step of a scene needs a workspace.");
    return state_->step(workspaces, parallel_for);
}

SceneStep Scene::step_with(std::span<const BoxPair> candidates, std::span<Workspace> workspaces,
                           ParallelFor parallel_for) noexcept {
    if (workspaces.empty()) stop_with("A step of a scene needs a workspace.");
    return state_->step_with(candidates, workspaces, parallel_for);
}

std::span<const WorldBox> Scene::boxes() noexcept {
    state_->place_changed();
    return {state_->boxes, state_->plan->limits().objects};
}

std::span<const SceneHit> Scene::hits() const noexcept {
    return {state_->hits, state_->hit_count};
}
std::span<const SceneDistance> Scene::distances() const noexcept {
    return {state_->distances, state_->distance_count};
}
std::span<const SceneOverlaps> Scene::overlaps() const noexcept {
    return {state_->overlaps, state_->overlap_count};
}
std::span<const SceneContacts> Scene::contacts() const noexcept {
    return {state_->contacts, state_->contact_count};
}
std::span<const SceneSelfOverlaps> Scene::self_overlaps() const noexcept {
    return {state_->self_overlaps, state_->self_overlap_count};
}
std::span<const SceneImpact> Scene::impacts() const noexcept {
    return {state_->impacts, state_->impact_count};
}
std::span<const SceneBoundedDistance> Scene::bounded_distances() const noexcept {
    return {state_->bounded_distances, state_->bounded_distance_count};
}
std::span<const SceneEvent> Scene::events() const noexcept {
    return {state_->events, state_->event_count};
}
const SceneCounts& Scene::counts() const noexcept {
    return state_->counts;
}
std::uint32_t Scene::object_count() const noexcept {
    return state_->object_count;
}
const Model* Scene::model_of(ObjectId object) const noexcept {
    const ObjectSlot* const found = state_->find(object);
    return found == nullptr ? nullptr : found->model;
}
std::optional<SceneObject> Scene::find(ObjectId object) const noexcept {
    const ObjectSlot* const found = state_->find(object);
    if (found == nullptr) return std::nullopt;
    return SceneObject{found->model, found->layer, found->pose};
}
ObjectId Scene::object_at(std::uint32_t slot) const noexcept {
    if (slot >= state_->plan->limits().objects) return {};
    const ObjectSlot& object = state_->objects[slot];
    return object.model == nullptr ? ObjectId{} : ObjectId{slot, object.generation};
}

std::uint64_t SceneCounts::calls_of(Ask effect) const noexcept {
    const std::size_t number = effect_number(effect);
    return number == kSceneEffects.size() ? 0 : calls[number];
}

std::uint64_t Scene::state_hash() const noexcept {
    const format::FloatEnvironment environment;
    Hash hash;
    const auto add_stream = [&](const auto& stream, const auto& add_result) {
        hash.add(std::uint64_t{stream.size()});
        for (const auto& result : stream) {
            hash.add(result.a);
            hash.add(result.b);
            hash.add(std::uint64_t{result.pair});
            add_result(result);
        }
    };
    add_stream(hits(), [&](const SceneHit& hit) {
        hash.add(static_cast<std::uint64_t>(hit.holds));
        const Containment& inside = hit.collision.containment;
        hash.add(static_cast<std::uint32_t>(hit.collision.hit),
                 static_cast<std::uint32_t>(inside.answer) << 1 | (inside.a_inside_b ? 1U : 0U));
        hash.add(inside.winding);
    });
    add_stream(overlaps(), [&](const SceneOverlaps& found) {
        hash.add(std::uint64_t{found.triangles.size()});
        for (const TrianglePair& pair : found.triangles) hash.add(pair.a, pair.b);
    });
    const auto add_own = [&](const SceneSelfOverlaps& found) {
        hash.add(found.object);
        hash.add(std::uint64_t{found.triangles.size()});
        for (const TrianglePair& pair : found.triangles) hash.add(pair.a, pair.b);
    };
    for (const SceneSelfOverlaps& found : self_overlaps()) add_own(found);
    // The bounds of an impact depend on the order of the search, and that on the instruction set.
    for (const SceneImpact& found : impacts()) {
        hash.add(found.a);
        hash.add(found.b);
        hash.add(static_cast<std::uint64_t>(found.impact.kind));
    }
    for (const SceneBoundedDistance& found : bounded_distances()) {
        hash.add(found.a);
        hash.add(found.b);
        hash.add(std::uint64_t{found.distance.is_complete ? 1U : 0U});
        hash.add(found.distance.lower);
        hash.add(found.distance.upper);
    }
    add_stream(distances(), [&](const SceneDistance& found) {
        hash.add(found.distance.lower);
        hash.add(found.distance.upper);
        // Which of the triangles that touch is found first depends on the instruction set.
        if (found.distance.upper == 0) return;
        hash.add(found.distance.triangle_a, found.distance.triangle_b);
    });
    add_stream(contacts(), [&](const SceneContacts& found) {
        hash.add(found.verdict.found);
        hash.add(std::uint64_t{found.contacts.size()});
        for (const Contact& contact : found.contacts) hash.add(contact);
    });
    add_stream(events(), [&](const SceneEvent& event) {
        hash.add(
            static_cast<std::uint32_t>(event.effect),
            static_cast<std::uint32_t>(event.reason) << 2 | static_cast<std::uint32_t>(event.kind));
    });
    return hash.value();
}

}  // namespace cdprep
