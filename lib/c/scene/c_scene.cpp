// SPDX-License-Identifier: MIT
#include "c/scene/c_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "c/c_model.h"
#include "c/c_workspace.h"
#include "c/pose_input.h"

namespace cdprep::c {

template <>
struct Input<cdprep_object_options> {
    static const InputType type;
    static cdprep_object_options defaults() noexcept {
        cdprep_object_options options{};
        options.world_from_model = kIdentity;
        return options;
    }
};

namespace {

constexpr std::array kFields = {
    Field{"model", offsetof(cdprep_object_options, model), Holds::pointer},
    Field{"layer", offsetof(cdprep_object_options, layer), Holds::choice, kLayers - 1},
    Field{"reserved", offsetof(cdprep_object_options, reserved), Holds::reserved},
    Field{"world_from_model", offsetof(cdprep_object_options, world_from_model), Holds::number, 0,
          12},
};

static_assert(alignof(cdprep_scene) <= CDPREP_ALIGNMENT);

/// The offset of each part of a scene's block. With 32 bits, the block may be larger than memory,
/// so nothing is computed in std::size_t.
struct Layout {
    explicit Layout(const Plan& plan) noexcept
        : hits(aligned(sizeof(cdprep_scene))),
          overlaps(hits + room_of<cdprep_scene_hit>(plan.limits().pairs)),
          distances(overlaps + room_of<cdprep_scene_overlap>(results_of(plan, Ask::overlap))),
          contacts(distances + room_of<cdprep_scene_distance>(results_of(plan, Ask::distance))),
          contact_items(contacts + room_of<cdprep_scene_contact>(results_of(plan, Ask::contacts))),
          events(contact_items + room_of<cdprep_contact>(contacts_of(plan))),
          self_overlaps(events + room_of<cdprep_event>(events_of(plan))),
          impacts(self_overlaps + room_of<cdprep_scene_self_overlap>(results_of(plan, Ask::self))),
          bounded_distances(impacts +
                            room_of<cdprep_scene_impact>(results_of(plan, Ask::continuous))),
          models(bounded_distances + room_of<cdprep_scene_bounded>(results_of(plan, Ask::haptic))),
          scene(models + room_of<const cdprep_model*>(plan.limits().objects)),
          scene_size(aligned(std::uint64_t{Scene::size(plan)})),
          size(scene + scene_size) {}

    template <class T>
    static std::uint64_t room_of(std::uint64_t count) noexcept {
        return aligned(count * sizeof(T));  // NOLINT(bugprone-sizeof-expression): also of pointers
    }
    static std::uint64_t results_of(const Plan& plan, Ask effect) noexcept {
        return contains(plan.effects(), effect) ? plan.limits().pairs : 0;
    }
    static std::uint64_t contacts_of(const Plan& plan) noexcept {
        return contains(plan.effects(), Ask::contacts) ? plan.limits().contacts : 0;
    }
    /// All effects of the last step end, and as many begin.
    static std::uint64_t events_of(const Plan& plan) noexcept {
        const auto effects = static_cast<std::uint32_t>(without(plan.effects(), kSceneChanges));
        return 2 * static_cast<std::uint64_t>(std::popcount(effects)) * plan.limits().pairs;
    }

    std::uint64_t hits;
    std::uint64_t overlaps;
    std::uint64_t distances;
    std::uint64_t contacts;
    std::uint64_t contact_items;
    std::uint64_t events;
    std::uint64_t self_overlaps;
    std::uint64_t impacts;
    std::uint64_t bounded_distances;
    std::uint64_t models;
    std::uint64_t scene;
    std::uint64_t scene_size;
    std::uint64_t size;
};

int find_size(Call& call, const Layout& layout, std::size_t& size) noexcept {
    return check_size(call, "The scene", layout.size, size);
}

/// Makes an array in the block. Elements are written before they are read.
template <class T>
T* array_at(std::byte* block, std::uint64_t offset) noexcept {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= CDPREP_ALIGNMENT);
    return reinterpret_cast<T*>(block + offset);
}

int make(Call& call, cdprep_plan& plan, const Given& given, cdprep_scene** to) noexcept {
    const Layout layout(plan.plan);
    std::size_t size = 0;
    if (const int code = find_size(call, layout, size)) return code;
    OwnedMemory own;
    std::byte* block = nullptr;
    if (const int code = take_memory(call, given, size, plan.allocator, own, block)) return code;
    assert(Scene::alignment() <= CDPREP_ALIGNMENT);
    std::optional<Scene> scene = Scene::in_memory(
        {block + layout.scene, static_cast<std::size_t>(layout.scene_size)}, plan.plan);
    if (!scene) return call.fail(CDPREP_INTERNAL, "The scene does not fit into its own memory.");
    const SceneResults results = {array_at<cdprep_scene_hit>(block, layout.hits),
                                  array_at<cdprep_scene_overlap>(block, layout.overlaps),
                                  array_at<cdprep_scene_distance>(block, layout.distances),
                                  array_at<cdprep_scene_contact>(block, layout.contacts),
                                  array_at<cdprep_contact>(block, layout.contact_items),
                                  array_at<cdprep_event>(block, layout.events),
                                  array_at<cdprep_scene_self_overlap>(block, layout.self_overlaps),
                                  array_at<cdprep_scene_impact>(block, layout.impacts),
                                  array_at<cdprep_scene_bounded>(block, layout.bounded_distances)};
    *to = new (block) cdprep_scene{std::move(*scene), &plan, results,
                                   array_at<const cdprep_model*>(block, layout.models), own.take()};
    plan.users.fetch_add(1, std::memory_order_relaxed);
    return CDPREP_OK;
}

ObjectId in_cpp(const cdprep_object& id) noexcept {
    return {id.slot, id.generation};
}

int check_object(Call& call, const Name& name, const cdprep_scene& scene,
                 const cdprep_object& id) noexcept {
    if (scene.scene.model_of(in_cpp(id)) != nullptr) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_STALE, name,
                       "is slot %u of generation %u; the scene has no such object.", id.slot,
                       id.generation);
}

int read_object(Call& call, const Name& name, const cdprep_object_options* from, const Plan& plan,
                SceneObject& object, const cdprep_model*& model) {
    cdprep_object_options given;
    if (const int code = read_input(call, name, from, given)) return code;
    if (const int code = read_rigid(call, name.of("world_from_model"), given.world_from_model,
                                    object.world_from_model)) {
        return code;
    }
    model = given.model;
    object.model = &model->model;
    object.layer = given.layer;
    return check_serves(call, name.of("model"), *given.model, plan.asks_of(given.layer));
}

/// Refuses arrays that are null but have elements, and more elements than memory holds.
template <class X, class Y>
int check_arrays(Call& call, std::size_t count, const char* x_name, const X* x, const char* y_name,
                 const Y* y) noexcept {
    if (count == 0) return CDPREP_OK;
    if (const int code = call.need(x, {x_name})) return code;
    if (const int code = call.need(y, {y_name})) return code;
    if (count <= PTRDIFF_MAX / std::max(sizeof(X), sizeof(Y))) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"count"}, "is more than memory holds.");
}

int check_objects(Call& call, const cdprep_scene& scene, const cdprep_object* ids,
                  std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        if (const int code = check_object(call, {"ids", i}, scene, ids[i])) return code;
    }
    return CDPREP_OK;
}

int check_room(Call& call, const cdprep_scene& scene, std::size_t count) noexcept {
    const std::uint32_t most = scene.plan->plan.limits().objects;
    const std::uint32_t room = most - scene.scene.object_count();
    if (count <= room) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"count"},
                       "is %zu; the scene has room for %u more of its %u objects.", count, room,
                       most);
}

int check_new(Call& call, const cdprep_scene& scene, const cdprep_object_options* objects,
              std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const Name name = {"objects", i};
        const cdprep_object_options* const given = element(objects, i);
        SceneObject object;
        const cdprep_model* model = nullptr;
        if (i > 0) {
            if (const int code = check_stride(call, name, objects, given)) return code;
        }
        if (const int code = read_object(call, name, given, scene.plan->plan, object, model)) {
            return code;
        }
    }
    return CDPREP_OK;
}

/// Adds objects that were checked. Arrays that change meanwhile end it.
void add_all(cdprep_scene& scene, const cdprep_object_options* objects, std::size_t count,
             cdprep_object* ids) {
    Call again(nullptr);
    for (std::size_t i = 0; i < count; ++i) {
        SceneObject object;
        const cdprep_model* model = nullptr;
        if (read_object(again, {"objects", i}, element(objects, i), scene.plan->plan, object,
                        model) != CDPREP_OK) {
            return;
        }
        const std::optional<ObjectId> id = scene.scene.add(object);
        if (!id) return;
        scene.models[id->slot] = model;
        ids[i] = {id->slot, id->generation};
    }
}

int check_poses(Call& call, const cdprep_pose* poses, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        Pose pose;
        if (const int code = read_pose(call, {"poses", i}, poses + i, pose)) return code;
    }
    return CDPREP_OK;
}

/// Refuses pairs of slots that are not sorted, occur twice or have no objects.
int check_candidates(Call& call, const cdprep_scene& scene, const cdprep_box_pair* candidates,
                     std::size_t count) noexcept {
    const char* const argument = "candidates";
    if (const int code = check_arrays(call, count, argument, candidates, argument, candidates)) {
        return code;
    }
    const std::uint32_t slots = scene.plan->plan.limits().objects;
    for (std::size_t i = 0; i < count; ++i) {
        const Name name = {argument, i};
        const auto [a, b] = candidates[i];
        if (a >= b || b >= slots) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name,
                               "has slots %u and %u; the first must be less than the second, and "
                               "both less than %u.",
                               a, b, slots);
        }
        const cdprep_box_pair before = i > 0 ? candidates[i - 1] : cdprep_box_pair{};
        if (before.a > a || (before.a == a && before.b >= b)) {
            return call.refuse(
                CDPREP_WHY_OUT_OF_RANGE, name,
                "has slots %u and %u after %u and %u; candidates must be sorted and unique.", a, b,
                before.a, before.b);
        }
        for (const std::uint32_t slot : {a, b}) {
            if (scene.scene.object_at(slot) != ObjectId{}) continue;
            return call.refuse(CDPREP_WHY_STALE, name, "names slot %u, which has no object.", slot);
        }
    }
    return CDPREP_OK;
}

/// Runs `change(call)`, which changes a scene that no other call uses.
template <class Change>
int change_scene(cdprep_scene* scene, cdprep_error* error, Change&& change) noexcept {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(scene, {"scene"})) return code;
        InUse use;
        if (const int code = use.begin(call, {"scene"}, scene->in_use)) return code;
        return change(call);
    });
}

/// Sets the poses of objects by a function of the scene.
int set_poses(cdprep_scene* scene, const cdprep_object* ids, const cdprep_pose* poses,
              std::size_t count, cdprep_error* error,
              bool (Scene::*set)(ObjectId, const Pose&) noexcept) noexcept {
    return change_scene(scene, error, [&](Call& call) -> int {
        if (const int code = check_arrays(call, count, "ids", ids, "poses", poses)) return code;
        if (const int code = check_objects(call, *scene, ids, count)) return code;
        if (const int code = check_poses(call, poses, count)) return code;
        Call again(nullptr);
        for (std::size_t i = 0; i < count; ++i) {
            Pose pose;
            if (read_pose(again, {"poses", i}, poses + i, pose) != CDPREP_OK) return CDPREP_OK;
            static_cast<void>((scene->scene.*set)(in_cpp(ids[i]), pose));
        }
        return CDPREP_OK;
    });
}

/// Runs a step. `check(call)` checks what else the caller gave; `run(threads)` computes.
template <class Check, class Run>
int step_scene(cdprep_scene* scene, cdprep_workspace* workspace, cdprep_step* step,
               cdprep_error* error, Check&& check, Run&& run) noexcept {
    if (step != nullptr) *step = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(scene, {"scene"})) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (const int code = call.need(step, {"step"})) return code;
        InUse scene_use, workspace_use;
        if (const int code = scene_use.begin(call, {"scene"}, scene->in_use)) return code;
        if (const int code = check(call)) return code;
        if (const int code = workspace_use.begin(call, *workspace)) return code;
        const SceneStep made = run(LanesThreads(*workspace));
        step->complete = made.complete ? CDPREP_YES : CDPREP_NO;
        step->needed_pairs = made.needed_pairs;
        step->needed_triangle_pairs = made.needed_triangle_pairs;
        step->needed_contacts = made.needed_contacts;
        if (made.complete) store_results(*scene);
        return CDPREP_OK;
    });
}

}  // namespace

const InputType Input<cdprep_object_options>::type = {"cdprep_object_options", 0xcd50000eU,
                                                      sizeof(cdprep_object_options),
                                                      sizeof(cdprep_object_options), kFields};

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;

int cdprep_scene_size(const cdprep_plan* plan, size_t* size, cdprep_error* error) {
    Call call(error);
    if (size != nullptr) *size = 0;
    if (const int code = call.need(plan, {"plan"})) return code;
    if (const int code = call.need(size, {"size"})) return code;
    return cdprep::c::find_size(call, cdprep::c::Layout(plan->plan), *size);
}

int cdprep_scene_make(cdprep_plan* plan, void* memory, size_t size, cdprep_scene** scene,
                      cdprep_error* error) {
    if (scene != nullptr) *scene = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(plan, {"plan"})) return code;
        if (const int code = call.need(scene, {"scene"})) return code;
        return cdprep::c::make(call, *plan, {memory, size}, scene);
    });
}

void cdprep_scene_end(cdprep_scene* scene) {
    if (scene == nullptr || scene->in_use.exchange(true)) return;
    const cdprep::c::Memory memory = scene->memory;
    cdprep_plan* const plan = scene->plan;
    std::destroy_at(scene);
    release(memory);
    cdprep_plan_end(plan);
}

void cdprep_object_options_init(cdprep_object_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_scene_add(cdprep_scene* scene, const cdprep_object_options* objects, size_t count,
                     cdprep_object* ids, cdprep_error* error) {
    if (ids != nullptr && count <= PTRDIFF_MAX / sizeof *ids) {
        std::fill_n(ids, count, cdprep_object{});
    }
    return cdprep::c::change_scene(scene, error, [&](Call& call) -> int {
        if (const int code = cdprep::c::check_arrays(call, count, "objects", objects, "ids", ids)) {
            return code;
        }
        if (const int code = cdprep::c::check_room(call, *scene, count)) return code;
        if (const int code = cdprep::c::check_new(call, *scene, objects, count)) return code;
        cdprep::c::add_all(*scene, objects, count, ids);
        return CDPREP_OK;
    });
}

int cdprep_scene_remove(cdprep_scene* scene, const cdprep_object* ids, size_t count,
                        cdprep_error* error) {
    return cdprep::c::change_scene(scene, error, [&](Call& call) -> int {
        if (const int code = cdprep::c::check_arrays(call, count, "ids", ids, "ids", ids)) {
            return code;
        }
        if (const int code = cdprep::c::check_objects(call, *scene, ids, count)) return code;
        for (size_t i = 0; i < count; ++i) {
            static_cast<void>(scene->scene.remove(cdprep::c::in_cpp(ids[i])));
        }
        return CDPREP_OK;
    });
}

int cdprep_scene_set_layer(cdprep_scene* scene, cdprep_object id, uint32_t layer,
                           cdprep_error* error) {
    return cdprep::c::change_scene(scene, error, [&](Call& call) -> int {
        if (const int code = cdprep::c::check_object(call, {"id"}, *scene, id)) return code;
        if (const int code = cdprep::c::check_layer(call, layer)) return code;
        const cdprep::ObjectId found = cdprep::c::in_cpp(id);
        const cdprep::Model& model = *scene->scene.model_of(found);
        const cdprep::Ask asks = scene->plan->plan.asks_of(layer);
        if (const int code = cdprep::c::check_serves(call, {"id"}, model, asks)) return code;
        static_cast<void>(scene->scene.set_layer(found, layer));
        return CDPREP_OK;
    });
}

int cdprep_scene_set_poses(cdprep_scene* scene, const cdprep_object* ids, const cdprep_pose* poses,
                           size_t count, cdprep_error* error) {
    return cdprep::c::set_poses(scene, ids, poses, count, error, &cdprep::Scene::set_pose);
}

int cdprep_scene_put(cdprep_scene* scene, const cdprep_object* ids, const cdprep_pose* poses,
                     size_t count, cdprep_error* error) {
    return cdprep::c::set_poses(scene, ids, poses, count, error, &cdprep::Scene::put);
}

int cdprep_scene_set_paused(cdprep_scene* scene, uint32_t effects, cdprep_error* error) {
    return cdprep::c::change_scene(scene, error, [&](Call& call) -> int {
        const cdprep::Ask effects_of_plan = scene->plan->plan.effects();
        const auto planned = static_cast<uint32_t>(without(effects_of_plan, cdprep::kSceneChanges));
        if ((effects & ~planned) != 0) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"effects"},
                               "is 0x%x; the plan computes only the bits 0x%x.", effects, planned);
        }
        scene->scene.set_paused(static_cast<cdprep::Ask>(effects));
        return CDPREP_OK;
    });
}

int cdprep_scene_step(cdprep_scene* scene, cdprep_workspace* workspace, cdprep_step* step,
                      cdprep_error* error) {
    return cdprep::c::step_scene(
        scene, workspace, step, error, [](Call& /*call*/) -> int { return CDPREP_OK; },
        [&](const cdprep::c::LanesThreads& threads) {
            return scene->scene.step(workspace->lanes, threads);
        });
}

int cdprep_scene_describe(const cdprep_scene* scene, cdprep_object id, cdprep_object_info* info,
                          cdprep_error* error) {
    if (info != nullptr) *info = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(scene, {"scene"})) return code;
        if (const int code = call.need(info, {"info"})) return code;
        if (const int code = cdprep::c::check_free(call, {"scene"}, scene->in_use)) return code;
        if (const int code = cdprep::c::check_object(call, {"id"}, *scene, id)) return code;
        const auto object = scene->scene.find(cdprep::c::in_cpp(id));
        assert(object.has_value());  // check_object() found it
        *info = {scene->models[id.slot], object->layer, 0,
                 cdprep::c::stored(object->world_from_model)};
        return CDPREP_OK;
    });
}

int cdprep_scene_object_at(const cdprep_scene* scene, uint32_t slot, cdprep_object* id,
                           cdprep_error* error) {
    Call call(error);
    if (id != nullptr) *id = {};
    if (const int code = call.need(scene, {"scene"})) return code;
    if (const int code = call.need(id, {"id"})) return code;
    if (const int code = cdprep::c::check_free(call, {"scene"}, scene->in_use)) return code;
    const uint32_t slots = scene->plan->plan.limits().objects;
    if (slot >= slots) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"slot"},
                           "is %u; the scene has %u slots, numbered from 0.", slot, slots);
    }
    const cdprep::ObjectId found = scene->scene.object_at(slot);
    *id = {found.slot, found.generation};
    return CDPREP_OK;
}

int cdprep_scene_set_clock(cdprep_scene* scene, cdprep_clock now, cdprep_error* error) {
    return cdprep::c::change_scene(scene, error, [&](Call& /*call*/) -> int {
        // The C++ type promises that it does not throw, as callbacks in C must not.
        scene->scene.set_clock(reinterpret_cast<cdprep::SceneClock>(now));
        return CDPREP_OK;
    });
}

int cdprep_scene_boxes(cdprep_scene* scene, const cdprep_world_box** boxes, size_t* count,
                       cdprep_error* error) {
    if (boxes != nullptr) *boxes = nullptr;
    if (count != nullptr) *count = 0;
    return cdprep::c::change_scene(scene, error, [&](Call& call) -> int {
        if (const int code = call.need(boxes, {"boxes"})) return code;
        if (const int code = call.need(count, {"count"})) return code;
        const std::span<const cdprep::WorldBox> all = scene->scene.boxes();
        *boxes = reinterpret_cast<const cdprep_world_box*>(all.data());
        *count = all.size();
        return CDPREP_OK;
    });
}

int cdprep_scene_step_with(cdprep_scene* scene, const cdprep_box_pair* candidates, size_t count,
                           cdprep_workspace* workspace, cdprep_step* step, cdprep_error* error) {
    return cdprep::c::step_scene(
        scene, workspace, step, error,
        [&](Call& call) -> int {
            return cdprep::c::check_candidates(call, *scene, candidates, count);
        },
        [&](const cdprep::c::LanesThreads& threads) {
            const std::span pairs(reinterpret_cast<const cdprep::BoxPair*>(candidates), count);
            return scene->scene.step_with(pairs, workspace->lanes, threads);
        });
}
