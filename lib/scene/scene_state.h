// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/broad_phase.h"
#include "cdprep/scene.h"
#include "core/carver.h"
#include "scene/ask_pair.h"
#include "scene/list_pages.h"
#include "scene/object_box.h"
#include "scene/scene_records.h"

namespace cdprep {

struct ObjectSlot {
    const Model* model = nullptr;  ///< null: the slot is free
    Pose pose;
    std::uint32_t layer = 0;
    std::uint32_t generation = 0;
    std::uint32_t last_layer = 0;  ///< in the last step that was complete, or when it was added
    bool is_changed = false;       ///< since that step
};

/// Returns the generation of the next object in a slot. After all numbers they begin again, without
/// 0.
constexpr std::uint32_t next_generation(std::uint32_t generation) noexcept {
    return generation + 1 == 0 ? 1 : generation + 1;
}

/// The ticks that one thread counts, by effect.
using EffectTicks = std::array<std::uint64_t, kSceneEffects.size()>;

inline std::size_t effect_count(Ask effects) noexcept {
    return static_cast<std::size_t>(std::popcount(static_cast<std::uint32_t>(effects)));
}

/// The most contacts of two objects.
inline std::size_t most_contacts_of(const Plan& plan) noexcept {
    std::uint32_t most = 0;
    for (const LayerPair& pair : plan.pairs()) {
        if (contains(pair.effects, Ask::contacts)) most = std::max(most, pair.contacts.most);
    }
    return most;
}

struct Scene::State {
    State(Carver& carver, const Plan& of) noexcept
        : plan(&of),
          planned(without(of.effects(), kSceneChanges)),
          changing_layers(of.layers_of(kSceneChanges)),
          self_layers(of.layers_of(Ask::self)),
          continuous_layers(of.layers_of(Ask::continuous)),
          objects(carver.take<ObjectSlot>(of.limits().objects)),
          roots(carver.take<RootBox>(of.limits().objects)),
          boxes(carver.take<WorldBox>(of.limits().objects)),
          filters(carver.take<BoxFilter>(of.limits().objects)),
          changed(carver.take<std::uint32_t>(of.limits().objects)),
          asked(carver.take<std::uint32_t>(of.limits().pairs)),
          kernels(carver.take<PairKernel>(of.pairs().size())),
          ticks(carver.take<EffectTicks>(of.limits().threads)),
          hits(carver.take<SceneHit>(of.limits().pairs)),
          events(carver.take<SceneEvent>(std::uint64_t{of.limits().pairs} * 2 *
                                         effect_count(planned))),
          last(carver, of),
          next(carver, of) {
        const SceneLimits& limits = of.limits();
        const auto has_parts = [](const PairRung& rung) { return rung.rung == Rung::parts; };
        if (std::any_of(of.rungs().begin(), of.rungs().end(), has_parts)) {
            parts = carver.take<EnclosingParts>(limits.objects);
        }
        if (is_planned(Ask::distance)) distances = carver.take<SceneDistance>(limits.pairs);
        if (changing_layers != 0 || self_layers != 0) {
            shapes = carver.take<std::uint64_t>(limits.objects);
        }
        if (is_planned(Ask::continuous)) {
            last_poses = carver.take<Pose>(limits.objects);
            impacts = carver.take<SceneImpact>(limits.pairs);
        }
        if (is_planned(Ask::haptic)) {
            bounded_distances = carver.take<SceneBoundedDistance>(limits.pairs);
        }
        if (is_planned(Ask::self)) self_overlaps = carver.take<SceneSelfOverlaps>(limits.objects);
        if (is_planned(Ask::overlap)) overlaps = carver.take<SceneOverlaps>(limits.pairs);
        if (is_planned(Ask::overlap) || is_planned(Ask::self)) {
            triangle_pairs.emplace(carver, limits.triangle_pairs, limits.threads);
        }
        if (is_planned(Ask::contacts)) {
            contacts = carver.take<SceneContacts>(limits.pairs);
            contact_pages.emplace(carver, limits.contacts, limits.threads);
            most_contacts = most_contacts_of(of);
            contact_room = carver.take<Contact>(std::uint64_t{limits.threads} * most_contacts);
        }
    }

    [[nodiscard]] bool is_planned(Ask effect) const noexcept {
        return contains(planned, effect);
    }
    /// The effects of a pair of layers that are not paused.
    [[nodiscard]] Ask effects_of(const Record& record) const noexcept {
        const LayerPair& pair = plan->pairs()[record.pair];
        return without(record.is_of_one() ? pair.effects & Ask::self : effects_between(pair),
                       paused);
    }
    [[nodiscard]] std::uint64_t now() const noexcept {
        return clock != nullptr ? clock() : 0;
    }
    [[nodiscard]] bool has_way(std::uint32_t slot) const noexcept;
    [[nodiscard]] bool has_new_shape(std::uint32_t slot) const noexcept;
    [[nodiscard]] std::uint32_t next_self(std::uint32_t slot) const noexcept;
    [[nodiscard]] std::uint64_t self_count() const noexcept;
    [[nodiscard]] ObjectSlot* find(ObjectId id) noexcept;
    void change(std::uint32_t slot) noexcept;
    void place(std::uint32_t slot) noexcept;
    void place_changed() noexcept;

    [[nodiscard]] bool is_changed(const Record& record) const noexcept;
    void add_candidate(BoxPair slots) noexcept;
    [[nodiscard]] std::uint64_t list_candidates(std::span<const BoxPair> candidates) noexcept;
    [[nodiscard]] bool is_candidate(BoxPair slots) const noexcept;
    [[nodiscard]] std::uint64_t list_given(std::span<const BoxPair> candidates) noexcept;
    void keep(std::uint32_t old, std::uint32_t now) noexcept;
    [[nodiscard]] bool follows_paused_distance(const Record& before, Ask effects) const noexcept;
    void keep_known() noexcept;
    void find_parts(std::uint32_t slot) noexcept;
    void choose_kernels() noexcept;
    [[nodiscard]] ListWriters start_lists(std::size_t worker) noexcept;
    [[nodiscard]] PairAnswer ask_two(std::uint32_t number, const ObjectSlot& a, const ObjectSlot& b,
                                     Workspace& workspace, const ListWriters& lists) noexcept;
    void ask(std::uint32_t number, Workspace& workspace, const ListWriters& lists) noexcept;
    void prefetch_search(std::uint32_t number) const noexcept;
    void ask_all(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept;
    [[nodiscard]] SceneStep place_lists() noexcept;
    void fill_lists(std::size_t threads, ParallelFor parallel_for) noexcept;
    void count_calls() noexcept;
    [[nodiscard]] EventReason reason_of(const Record& record, Ask effect,
                                        EventKind kind) const noexcept;
    void add_events(const Record& record, Ask effects, EventKind kind) noexcept;
    void list_events() noexcept;
    void list_results() noexcept;
    void list_lists_of(std::uint32_t number) noexcept;
    void list_contacts_of(std::uint32_t number) noexcept;
    void accept_changes() noexcept;
    [[nodiscard]] SceneStep compute(std::uint64_t begin, std::span<Workspace> workspaces,
                                    ParallelFor parallel_for) noexcept;
    SceneStep step(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept;
    SceneStep step_with(std::span<const BoxPair> candidates, std::span<Workspace> workspaces,
                        ParallelFor parallel_for) noexcept;

    const Plan* plan;
    Ask planned;  ///< effects
    std::uint32_t changing_layers, self_layers, continuous_layers;
    Ask paused = Ask::nothing;
    Ask last_paused = Ask::nothing;  ///< in the last step that was complete
    std::optional<BroadPhase> broad_phase;
    bool broad_phase_is_late = false;  ///< it has not seen the boxes of the last step
    ObjectSlot* objects;               ///< by slot, as the next three
    RootBox* roots;
    WorldBox* boxes;
    BoxFilter* filters;
    std::uint32_t* changed;  ///< slots
    std::uint32_t* asked;    ///< numbers of records in `next`
    PairKernel* kernels;     ///< of this step, by pair of layers
    EffectTicks* ticks;      ///< by worker
    /// By slot: the content hash of the model in the last step that was complete.
    std::uint64_t* shapes = nullptr;
    /// By slot: where its way begins, which is the pose of that step or of put().
    Pose* last_poses = nullptr;
    EnclosingParts* parts = nullptr;  ///< by slot; null: no rung has parts
    SceneClock clock = nullptr;
    SceneHit* hits;
    SceneEvent* events;
    SceneDistance* distances = nullptr;
    SceneOverlaps* overlaps = nullptr;
    SceneContacts* contacts = nullptr;
    SceneSelfOverlaps* self_overlaps = nullptr;
    SceneImpact* impacts = nullptr;
    SceneBoundedDistance* bounded_distances = nullptr;
    Records last;
    Records next;
    std::optional<ListPages<TrianglePair>> triangle_pairs;  ///< of `asked`
    std::optional<ListPages<Contact>> contact_pages;        ///< of `asked`
    Contact* contact_room = nullptr;                        ///< of two objects, by worker
    std::size_t most_contacts = 0;                          ///< of two objects

    std::uint32_t changed_count = 0;
    std::uint32_t asked_count = 0;
    std::uint32_t first_free = 0;  ///< no slot below is free
    std::uint32_t object_count = 0;
    std::size_t hit_count = 0, event_count = 0, distance_count = 0;
    std::size_t overlap_count = 0, contact_count = 0;  ///< pairs of objects
    std::size_t self_overlap_count = 0, impact_count = 0, bounded_distance_count = 0;
    std::uint64_t box_ticks = 0, query_ticks = 0;
    SceneCounts counts;
};

}  // namespace cdprep
