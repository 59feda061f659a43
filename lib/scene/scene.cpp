// SPDX-License-Identifier: MIT
#include "cdprep/scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <new>
#include <utility>

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "core/share_out.h"
#include "scene/carver.h"
#include "scene/object_box.h"

namespace cdprep {
namespace {

struct Object {
    const Model* model = nullptr;  ///< null: the slot is free
    Pose pose;
    std::uint32_t layer = 0;
    std::uint32_t generation = 0;
    std::uint32_t last_layer = 0;  ///< in the last step that was complete, or when it was added
    bool is_changed = false;       ///< since that step
};

/// What is known of two objects whose boxes meet.
struct Record {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair = 0;
    Ask holds = Ask::nothing;
    Collision collision;
    bool is_new = false;    ///< looked at in this step
    bool is_apart = false;  ///< by the root boxes: nothing is asked

    [[nodiscard]] BoxPair slots() const noexcept {
        return {a.slot, b.slot};
    }
    [[nodiscard]] bool is_same(const Record& other) const noexcept {
        return a == other.a && b == other.b && pair == other.pair;
    }
};

/// The records of a step, sorted by slots, and their distances if the plan asks for any.
struct Records {
    Record* record = nullptr;
    Distance* distance = nullptr;
    std::uint32_t count = 0;
};

/// Calls `visit(i, j)` for each pair of slots: with the index of its record in x and in y, or the
/// count where it has none.
template <class Visit>
void merge(const Records& x, const Records& y, const Visit& visit) {
    std::uint32_t i = 0, j = 0;
    while (i < x.count || j < y.count) {
        const bool takes_x =
            j == y.count || (i < x.count && x.record[i].slots() <= y.record[j].slots());
        const bool takes_y =
            i == x.count || (j < y.count && y.record[j].slots() <= x.record[i].slots());
        visit(takes_x ? i : x.count, takes_y ? j : y.count);
        i += takes_x ? 1 : 0;
        j += takes_y ? 1 : 0;
    }
}

/// A hash of numbers, one after the other (the mixing of SplitMix64, Steele et al. 2014).
class Hash {
public:
    void add(std::uint64_t number) noexcept {
        std::uint64_t x = value_ + 0x9e3779b97f4a7c15 + number;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
        x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
        value_ = x ^ (x >> 31);
    }
    void add(const ObjectId& id) noexcept {
        add(std::uint64_t{id.slot} << 32 | id.generation);
    }
    [[nodiscard]] std::uint64_t value() const noexcept {
        return value_;
    }

private:
    std::uint64_t value_ = 0;
};

std::size_t effect_count(const Plan& plan) noexcept {
    return static_cast<std::size_t>(std::popcount(static_cast<std::uint32_t>(plan.effects())));
}

}  // namespace

struct Scene::State {
    State(Carver& carver, const Plan& of) noexcept
        : plan(&of),
          objects(carver.take<Object>(of.limits().objects)),
          roots(carver.take<RootBox>(of.limits().objects)),
          boxes(carver.take<WorldBox>(of.limits().objects)),
          filters(carver.take<BoxFilter>(of.limits().objects)),
          changed(carver.take<std::uint32_t>(of.limits().objects)),
          asked(carver.take<std::uint32_t>(of.limits().pairs)),
          hits(carver.take<SceneHit>(of.limits().pairs)),
          events(carver.take<SceneEvent>(2 * effect_count(of) * of.limits().pairs)) {
        const bool has_distance = contains(of.effects(), Ask::distance);
        for (Records* records : {&last, &next}) {
            records->record = carver.take<Record>(of.limits().pairs);
            if (has_distance) records->distance = carver.take<Distance>(of.limits().pairs);
        }
        if (has_distance) distances = carver.take<SceneDistance>(of.limits().pairs);
    }

    [[nodiscard]] Object* find(ObjectId id) noexcept;
    void change(std::uint32_t slot) noexcept;
    void place(std::uint32_t slot) noexcept;
    [[nodiscard]] bool is_changed(const Record& record) const noexcept;
    void list_candidates(std::span<const BoxPair> candidates) noexcept;
    void ask(Record& record, Distance* distance, Workspace& workspace) const noexcept;
    void ask_all(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept;
    void count_calls() noexcept;
    [[nodiscard]] EventReason reason_of(const Record& record, bool begins) const noexcept;
    void add_events(const Record& record, Ask effects, bool begins) noexcept;
    void list_events() noexcept;
    void list_results() noexcept;
    SceneStep step(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept;

    const Plan* plan;
    std::optional<BroadPhase> broad_phase;
    Object* objects;  ///< by slot, as the next three
    RootBox* roots;
    WorldBox* boxes;
    BoxFilter* filters;
    std::uint32_t* changed;  ///< slots
    std::uint32_t* asked;    ///< numbers of records in `next`
    SceneHit* hits;
    SceneEvent* events;
    SceneDistance* distances = nullptr;
    Records last;
    Records next;

    std::uint32_t changed_count = 0;
    std::uint32_t asked_count = 0;
    std::uint32_t first_free = 0;  ///< no slot below is free
    std::uint32_t object_count = 0;
    std::size_t hit_count = 0, event_count = 0, distance_count = 0;
    SceneCounts counts;
};

// Objects -----------------------------------------------------------------------------------------

Object* Scene::State::find(ObjectId id) noexcept {
    if (id.slot >= plan->limits().objects || id.generation == 0) return nullptr;
    Object& object = objects[id.slot];
    return object.model != nullptr && object.generation == id.generation ? &object : nullptr;
}

void Scene::State::change(std::uint32_t slot) noexcept {
    if (!std::exchange(objects[slot].is_changed, true)) changed[changed_count++] = slot;
}

/// Brings the box and the filter of a slot up to date.
void Scene::State::place(std::uint32_t slot) noexcept {
    const Object& object = objects[slot];
    if (object.model == nullptr) {
        boxes[slot] = {{1, 1, 1}, {-1, -1, -1}};
        filters[slot] = {0, 0};
    } else {
        roots[slot] = root_box(*object.model, object.pose, plan->reach_of(object.layer));
        boxes[slot] = world_box(roots[slot]);
        filters[slot] = plan->filter_of(object.layer);
    }
}

// A step ------------------------------------------------------------------------------------------

bool Scene::State::is_changed(const Record& record) const noexcept {
    return objects[record.a.slot].is_changed || objects[record.b.slot].is_changed;
}

/// Fills `next` with a record for each candidate. Takes what the last step knew of two objects that
/// have not changed, and lists the others to be asked.
void Scene::State::list_candidates(std::span<const BoxPair> candidates) noexcept {
    next.count = static_cast<std::uint32_t>(candidates.size());
    for (std::uint32_t i = 0; i < next.count; ++i) {
        const auto [a, b] = candidates[i];
        next.record[i] = {.a = {a, objects[a].generation},
                          .b = {b, objects[b].generation},
                          .pair = *plan->find_pair(objects[a].layer, objects[b].layer),
                          .collision = {},
                          .is_new = true};
    }
    merge(last, next, [&](std::uint32_t old, std::uint32_t now) {
        if (old == last.count || now == next.count) return;
        Record& record = next.record[now];
        if (is_changed(record) || !record.is_same(last.record[old])) return;
        record = last.record[old];
        record.is_new = false;
        if (next.distance != nullptr) next.distance[now] = last.distance[old];
    });
    asked_count = 0;
    for (std::uint32_t i = 0; i < next.count; ++i) {
        if (next.record[i].is_new) asked[asked_count++] = i;
    }
}

/// Asks what the plan asks for.
void Scene::State::ask(Record& record, Distance* distance, Workspace& workspace) const noexcept {
    const format::FloatEnvironment environment;
    record.is_apart = !may_meet(roots[record.a.slot], roots[record.b.slot]);
    if (record.is_apart) return;
    const LayerPair& asks = plan->pairs()[record.pair];
    const Object &a = objects[record.a.slot], &b = objects[record.b.slot];
    const Pair pair{*a.model,
                    *b.model,
                    Placement::world(a.pose, b.pose),
                    {.body = asks.body, .overlap = asks.overlap}};
    if (contains(asks.effects, Ask::collide)) {
        record.collision = collide(pair, workspace);
        if (record.collision.hit == Answer::yes) record.holds = record.holds | Ask::collide;
    }
    if (contains(asks.effects, Ask::within) && within(pair, asks.tolerance, workspace)) {
        record.holds = record.holds | Ask::within;
    }
    if (contains(asks.effects, Ask::distance)) {
        const auto found = cdprep::distance(pair, workspace, {.max_distance = asks.max_distance});
        if (!found) return;
        *distance = *found;
        record.holds = record.holds | Ask::distance;
    }
}

void Scene::State::ask_all(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept {
    const std::size_t threads = std::min<std::size_t>(workspaces.size(), plan->limits().threads);
    share_jobs(asked_count, threads, parallel_for, [&](std::size_t job, std::size_t worker) {
        const std::uint32_t number = asked[job];
        Distance* const room = next.distance != nullptr ? next.distance + number : nullptr;
        ask(next.record[number], room, workspaces[worker]);
    });
}

void Scene::State::count_calls() noexcept {
    counts = {.moved = changed_count, .candidates = next.count, .kept = next.count - asked_count};
    for (std::uint32_t i = 0; i < asked_count; ++i) {
        counts.apart += next.record[asked[i]].is_apart ? 1 : 0;
        if (next.record[asked[i]].is_apart) continue;
        const Ask effects = plan->pairs()[next.record[asked[i]].pair].effects;
        counts.collide += contains(effects, Ask::collide) ? 1 : 0;
        counts.within += contains(effects, Ask::within) ? 1 : 0;
        counts.distance += contains(effects, Ask::distance) ? 1 : 0;
    }
}

EventReason Scene::State::reason_of(const Record& record, bool begins) const noexcept {
    const Object &a = objects[record.a.slot], &b = objects[record.b.slot];
    const auto is_gone = [](const Object& object, const ObjectId& id) {
        return object.model == nullptr || object.generation != id.generation;
    };
    if (!begins && (is_gone(a, record.a) || is_gone(b, record.b))) return EventReason::removed;
    const bool is_relayered = a.layer != a.last_layer || b.layer != b.last_layer;
    return is_relayered ? EventReason::relayered : EventReason::moved;
}

void Scene::State::add_events(const Record& record, Ask effects, bool begins) noexcept {
    for (const Ask effect : kSceneEffects) {
        if (!contains(effects, effect)) continue;
        events[event_count++] = {record.a, record.b, record.pair,
                                 effect,   begins,   reason_of(record, begins)};
    }
}

/// Lists what begins and ends from the last step to the next.
void Scene::State::list_events() noexcept {
    event_count = 0;
    const Record none;
    merge(last, next, [&](std::uint32_t old, std::uint32_t now) {
        const Record& before = old < last.count ? last.record[old] : none;
        const Record& after = now < next.count ? next.record[now] : none;
        const Ask common = before.is_same(after) ? before.holds & after.holds : Ask::nothing;
        add_events(before, without(before.holds, common), false);
        add_events(after, without(after.holds, common), true);
    });
}

void Scene::State::list_results() noexcept {
    hit_count = distance_count = 0;
    for (std::uint32_t i = 0; i < last.count; ++i) {
        const Record& record = last.record[i];
        if (record.holds == Ask::nothing && record.collision.hit == Answer::no) continue;
        hits[hit_count++] = {record.a, record.b, record.pair, record.holds, record.collision};
        if (!contains(record.holds, Ask::distance)) continue;
        distances[distance_count++] = {record.a, record.b, record.pair, last.distance[i]};
    }
}

SceneStep Scene::State::step(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept {
    {
        const format::FloatEnvironment environment;
        for (std::uint32_t i = 0; i < changed_count; ++i) place(changed[i]);
    }
    const std::size_t size = plan->limits().objects;
    const BroadPhaseUpdate candidates = broad_phase->update_moved(
        {boxes, size}, {filters, size}, {changed, changed_count}, parallel_for);
    assert(!candidates.refused);  // boxes of valid poses are numbers
    if (!candidates.complete) return {.complete = false, .needed_pairs = candidates.needed};
    list_candidates(candidates.pairs);
    ask_all(workspaces, parallel_for);
    count_calls();
    list_events();
    std::swap(last, next);
    list_results();
    for (std::uint32_t i = 0; i < changed_count; ++i) {
        Object& object = objects[changed[i]];
        object.is_changed = false;
        object.last_layer = object.layer;
    }
    changed_count = 0;
    return {};
}

// The class ---------------------------------------------------------------------------------------

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
    return carver.used() + BroadPhase::size(broad_phase_limits(plan));
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
    if (object.layer >= kLayers) stop_with("A scene has 32 layers; an object is in another.");
    require(*object.model, state.plan->asks_of(object.layer));
    const std::uint32_t most = state.plan->limits().objects;
    std::uint32_t& slot = state.first_free;
    while (slot < most && state.objects[slot].model != nullptr) ++slot;
    if (slot == most) return std::nullopt;
    Object& place = state.objects[slot];
    place.model = object.model;
    place.pose = object.world_from_model;
    place.layer = place.last_layer = object.layer;
    if (++place.generation == 0) place.generation = 1;
    state.change(slot);
    ++state.object_count;
    return ObjectId{slot, place.generation};
}

bool Scene::remove(ObjectId object) noexcept {
    State& state = *state_;
    Object* const found = state.find(object);
    if (found == nullptr) return false;
    found->model = nullptr;
    state.change(object.slot);
    state.first_free = std::min(state.first_free, object.slot);
    --state.object_count;
    return true;
}

bool Scene::set_pose(ObjectId object, const Pose& world_from_model) noexcept {
    Object* const found = state_->find(object);
    if (found == nullptr) return false;
    found->pose = world_from_model;
    state_->change(object.slot);
    return true;
}

bool Scene::set_layer(ObjectId object, std::uint32_t layer) noexcept {
    Object* const found = state_->find(object);
    if (found == nullptr) return false;
    if (layer >= kLayers) stop_with("A scene has 32 layers; an object is in another.");
    require(*found->model, state_->plan->asks_of(layer));
    if (found->layer == layer) return true;
    found->layer = layer;
    state_->change(object.slot);
    return true;
}

SceneStep Scene::step(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept {
    if (workspaces.empty()) stop_with("A step of a scene needs a workspace.");
    return state_->step(workspaces, parallel_for);
}

std::span<const SceneHit> Scene::hits() const noexcept {
    return {state_->hits, state_->hit_count};
}
std::span<const SceneDistance> Scene::distances() const noexcept {
    return {state_->distances, state_->distance_count};
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
    const Object* const found = state_->find(object);
    return found == nullptr ? nullptr : found->model;
}

std::uint64_t Scene::state_hash() const noexcept {
    Hash hash;
    for (const std::size_t count : {hits().size(), distances().size(), events().size()}) {
        hash.add(count);
    }
    const auto add = [&](const ObjectId& a, const ObjectId& b, std::uint32_t pair) {
        hash.add(a);
        hash.add(b);
        hash.add(pair);
    };
    for (const SceneHit& hit : hits()) {
        add(hit.a, hit.b, hit.pair);
        hash.add(static_cast<std::uint64_t>(hit.holds));
        hash.add(static_cast<std::uint64_t>(hit.collision.hit));
    }
    for (const SceneDistance& found : distances()) {
        add(found.a, found.b, found.pair);
        hash.add(std::bit_cast<std::uint64_t>(found.distance.lower));
        hash.add(std::bit_cast<std::uint64_t>(found.distance.upper));
        hash.add(std::uint64_t{found.distance.triangle_a} << 32 | found.distance.triangle_b);
    }
    for (const SceneEvent& event : events()) {
        add(event.a, event.b, event.pair);
        hash.add(std::uint64_t{static_cast<std::uint32_t>(event.effect)} << 32 |
                 static_cast<std::uint32_t>(event.reason) << 1 | (event.begins ? 1U : 0U));
    }
    return hash.value();
}

}  // namespace cdprep
