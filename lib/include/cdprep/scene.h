// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/bounded_distance.h"
#include "cdprep/contacts.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/plan.h"
#include "cdprep/pose.h"
#include "cdprep/time_of_impact.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// The id of an object of a scene. A slot that is used again gets a new generation; generation 0
/// means no object.
struct ObjectId {
    std::uint32_t slot = 0;
    std::uint32_t generation = 0;
    auto operator<=>(const ObjectId&) const = default;
};

/// An object to add. The model must outlive the object, and serve Plan::asks_of(layer). The next
/// step finds a change of a LiveModel if a LayerPair with `layer` has Ask::deform or Ask::tear. In
/// other layers, call set_pose() for each object of the model after a change, even with the same
/// pose.
struct SceneObject {
    const Model* model = nullptr;
    std::uint32_t layer = 0;
    Pose world_from_model;
};

/// Two objects for which an effect holds: a.slot < b.slot. For `self`, a and b are the same object.
struct SceneHit {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair;  ///< the pair of layers: an index into Plan::pairs()
    /// The effects that hold. With LayerPair::max_error, see Rung. `distance` holds if the distance
    /// is at most max_distance. `overlap`, `self` and `contacts` hold if their list has items.
    /// `continuous` holds if ImpactKind is not `none`. `haptic` holds unless the distance is proven
    /// to exceed max_distance.
    Ask holds;
    /// The answer of `collide`. If it is unknown, the objects are listed, but `collide` does not
    /// hold.
    Collision collision;
};

/// The distance of two objects. With LayerPair::max_error, its bounds are at most as wide as Rung
/// states. If parts give the distance (Rung::parts), it has no triangles, and its witnesses lie on
/// parts.
struct SceneDistance {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair;
    Distance distance;  ///< A is the object with the lower slot; witnesses are in the world
};

/// All pairs of overlapping triangles of two objects, in the order of TrianglePair.
struct SceneOverlaps {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair;
    std::span<const TrianglePair> triangles;  ///< A is the object with the lower slot
};

/// The triangles of one object that overlap each other, as self_overlaps() finds them.
struct SceneSelfOverlaps {
    ObjectId object;
    std::uint32_t pair;
    std::span<const TrianglePair> triangles;
};

/// The time at which two objects first touch between the last step's poses and the present ones. If
/// Motion::between() rejects a motion, the kind is `unfinished` and `lower` is 0.
struct SceneImpact {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair;
    Impact impact;  ///< times from 0 to 1; its nearest points are in the world
};

/// The distance of two objects, or bounds of it if LayerPair::work does not suffice.
struct SceneBoundedDistance {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair;
    BoundedDistance distance;
    /// The last complete answer since their boxes met. It is `distance` if that is complete. If a
    /// model has changed since then, the answer is about the old shape.
    LastDistance last;
};

/// The contacts of two objects, in the world. Normals point from the object with the lower slot to
/// the other.
struct SceneContacts {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair;
    std::span<const Contact> contacts;
    ContactsVerdict verdict;  ///< what `most` and `work` of LayerPair::contacts left out
};

enum class EventKind : std::uint32_t {
    ends,
    stays,  ///< listed only if LayerPair::lists_stays
    begins,
};

/// The reason for an event.
enum class EventReason : std::uint32_t {
    /// An object moved, changed or was added, or step_with() got other pairs than in the last step.
    /// With `continuous`, an object also counts as moved in the step after its last motion.
    moved,
    removed,    ///< an object was removed
    relayered,  ///< an object is in another layer than in the last step
    paused,     ///< the effect was paused or resumed
    unchanged,  ///< for EventKind::stays: neither object moved
};

/// An effect that begins, goes on or ceases to hold for two objects. For the same objects and
/// effect, there is exactly one EventKind::ends between two successive EventKind::begins.
struct SceneEvent {
    ObjectId a;
    ObjectId b;          ///< for `self`, the same object as a
    std::uint32_t pair;  ///< the pair of layers when the effect began
    Ask effect;          ///< one of kSceneEffects
    EventKind kind;
    EventReason reason;
};

/// A clock of the caller for SceneCounts, in ticks of any unit. It must be safe to call on any
/// thread.
using SceneClock = std::uint64_t (*)() noexcept;

/// The work of a step. A query is not called if its answer follows from another one. For surfaces,
/// collide() follows from overlaps(). In most cases, collide() and within() also follow from
/// distance().
struct SceneCounts {
    /// Objects that moved, changed, were added, removed or relayered. With `continuous`, an object
    /// also counts in the step after its last motion.
    std::uint64_t moved = 0;
    /// Pairs whose boxes meet, and objects that are tested against themselves.
    std::uint64_t candidates = 0;
    std::uint64_t kept = 0;   ///< candidates whose results were kept: no query runs
    std::uint64_t apart = 0;  ///< candidates whose oriented boxes are apart: no query runs
    std::array<std::uint64_t, kSceneEffects.size()> calls{};  ///< in the order of kSceneEffects
    /// The total length of the lists of overlaps() and self_overlaps().
    std::uint64_t triangle_pairs = 0;
    std::uint64_t contacts = 0;  ///< the total length of the lists of contacts()

    /// With Scene::set_clock(), the ticks of the queries of each effect, summed over all threads.
    /// In the order of kSceneEffects.
    std::array<std::uint64_t, kSceneEffects.size()> ticks{};
    /// The ticks of the stages of a step, one after the other. They add up to the whole step.
    std::uint64_t box_ticks = 0;    ///< of boxes, the broad phase and the reuse of results
    std::uint64_t query_ticks = 0;  ///< of all queries, from start to end
    std::uint64_t list_ticks = 0;   ///< of lists and events

    /// Returns the calls of one effect; 0 if it is none of kSceneEffects.
    [[nodiscard]] CDPREP_API std::uint64_t calls_of(Ask effect) const noexcept;
};

/// The result of Scene::step(). If the step is not complete, no result has changed, and sufficient
/// limits are given. If SceneLimits::pairs is too small, no lists are computed. Then their limits
/// remain unchecked.
struct SceneStep {
    bool complete = true;
    std::uint64_t needed_pairs = 0;           ///< a sufficient SceneLimits::pairs; 0: it sufficed
    std::uint64_t needed_triangle_pairs = 0;  ///< of SceneLimits::triangle_pairs, likewise
    std::uint64_t needed_contacts = 0;        ///< of SceneLimits::contacts, likewise
};

/// Many objects that move. A step runs the plan's queries for pairs of objects near each other. If
/// nothing about a pair has changed since the last step, its results are kept.
///
/// Results are sorted by the slots of a and b. They do not depend on threads. Without
/// LayerPair::max_error, they equal those of single queries with Placement::world. They stay valid
/// until the next step that is complete. After construction nothing is allocated, unless
/// Motion::between() rejects a motion of a step.
///
///     cdprep::Scene scene(plan);
///     const auto crate = scene.add({.model = &model, .layer = 1, .world_from_model = pose});
///     scene.set_pose(*crate, next);
///     if (scene.step(workspaces).complete) use(scene.events());
class Scene {
public:
    /// Allocates the memory for plan.limits(). The plan must outlive the scene, unchanged.
    CDPREP_API explicit Scene(const Plan& plan);
    explicit Scene(Plan&& plan) = delete;

    /// Makes a scene in the caller's memory. The memory and the plan must outlive it. Returns
    /// nothing if the memory is smaller than size() or not aligned to alignment().
    [[nodiscard]] CDPREP_API static std::optional<Scene> in_memory(std::span<std::byte> memory,
                                                                   const Plan& plan) noexcept;
    static std::optional<Scene> in_memory(std::span<std::byte> memory, Plan&& plan) = delete;
    /// Returns the size in bytes. If std::size_t has 32 bits and the size does not fit, returns a
    /// number of bytes that no memory has.
    [[nodiscard]] CDPREP_API static std::size_t size(const Plan& plan) noexcept;
    [[nodiscard]] CDPREP_API static std::size_t alignment() noexcept;  ///< bytes, a power of two

    CDPREP_API Scene(Scene&&) noexcept;
    CDPREP_API Scene& operator=(Scene&&) noexcept;
    CDPREP_API ~Scene();

    /// Adds an object to the lowest free slot. Returns nothing if the scene is full. Stops the
    /// program if the model is null, the layer is unknown, or the model does not serve
    /// Plan::asks_of(layer).
    CDPREP_API std::optional<ObjectId> add(const SceneObject& object) noexcept;
    /// Removes an object. The next step lists the end of each effect that held for it. Returns
    /// false if there is none with this id.
    CDPREP_API bool remove(ObjectId object) noexcept;
    /// Moves an object. Returns false if there is none with this id. For `continuous`, the object's
    /// way begins at its pose in the last complete step. If add() or put() was called since then,
    /// the way begins at the pose of that call. The motion is that of Motion::between(), about the
    /// centre of the model's box.
    CDPREP_API bool set_pose(ObjectId object, const Pose& world_from_model) noexcept;
    /// Puts an object at a pose, without a way for `continuous`. Returns false if there is none
    /// with this id.
    CDPREP_API bool put(ObjectId object, const Pose& world_from_model) noexcept;
    /// Changes the layer of an object. Returns false if there is none with this id. Stops the
    /// program as add() does.
    CDPREP_API bool set_layer(ObjectId object, std::uint32_t layer) noexcept;

    /// Pauses these effects from the next step on, and resumes all others. Paused effects are not
    /// computed. If one held, the next step lists its end. Effects that the plan does not ask for
    /// are ignored.
    CDPREP_API void set_paused(Ask effects) noexcept;

    /// Sets the clock for the ticks of SceneCounts. With null, the initial value, no clock is read,
    /// and the ticks are 0.
    CDPREP_API void set_clock(SceneClock clock) noexcept;

    /// Computes the effects of all objects as they are now. Uses as many workspaces as
    /// limits.threads allows; there must be at least one. Calls `parallel_for` at most five times.
    CDPREP_API SceneStep step(std::span<Workspace> workspaces,
                              ParallelFor parallel_for = serial_for) noexcept;
    /// Does the same as step(), with pairs of slots that the caller's own broad phase found. The
    /// pairs may have any order, and so may the two slots of a pair. They must contain every pair
    /// whose layers are paired and whose boxes meet: the scene does not find missing pairs. Pairs
    /// of free slots, of layers that are not paired and of boxes that do not meet are ignored. If
    /// pairs are listed twice, needed_pairs may be larger than necessary.
    CDPREP_API SceneStep step_with(std::span<const BoxPair> candidates,
                                   std::span<Workspace> workspaces,
                                   ParallelFor parallel_for = serial_for) noexcept;
    /// Returns the box of each slot in the next step, for the broad phase of step_with(). Boxes are
    /// relative to the plan's origin. With `continuous`, a box contains the whole way. Free slots
    /// have absent boxes, and so do objects of a layer without effects between two objects.
    [[nodiscard]] CDPREP_API std::span<const WorldBox> boxes() noexcept;

    [[nodiscard]] CDPREP_API std::span<const SceneHit> hits() const noexcept;
    [[nodiscard]] CDPREP_API std::span<const SceneOverlaps> overlaps() const noexcept;
    [[nodiscard]] CDPREP_API std::span<const SceneDistance> distances() const noexcept;
    [[nodiscard]] CDPREP_API std::span<const SceneSelfOverlaps> self_overlaps() const noexcept;
    [[nodiscard]] CDPREP_API std::span<const SceneImpact> impacts() const noexcept;
    [[nodiscard]] CDPREP_API std::span<const SceneBoundedDistance> bounded_distances()
        const noexcept;
    /// If LayerPair::contacts.work ended the search for two objects, they are listed even without
    /// contacts.
    [[nodiscard]] CDPREP_API std::span<const SceneContacts> contacts() const noexcept;
    /// The events of the last step that was complete, in the order of hits. For the same objects,
    /// ends come before stays, and stays before begins.
    [[nodiscard]] CDPREP_API std::span<const SceneEvent> events() const noexcept;
    [[nodiscard]] CDPREP_API const SceneCounts& counts() const noexcept;
    [[nodiscard]] CDPREP_API std::uint32_t object_count() const noexcept;
    /// Returns the model of an object, or null if there is none with this id.
    [[nodiscard]] CDPREP_API const Model* model_of(ObjectId object) const noexcept;
    /// Returns an object as it is now, or nothing if there is none with this id.
    [[nodiscard]] CDPREP_API std::optional<SceneObject> find(ObjectId object) const noexcept;
    /// Returns the object in a slot, or an id with generation 0 if there is none.
    [[nodiscard]] CDPREP_API ObjectId object_at(std::uint32_t slot) const noexcept;
    /// Returns a hash of the results, to compare runs. The hash leaves out the witnesses of
    /// distances, and the triangles of distances of 0. Of bounded distances, it includes only the
    /// objects, `is_complete` and the bounds. Of impacts, it includes only the objects and the
    /// kind. Of contacts, it leaves out features, `members` and the coordinates of manifold points.
    /// Of ContactsVerdict, it includes only `found`. The hash is equal for any number of threads.
    /// It is also equal for any instruction set, with three exceptions: answers of `haptic`,
    /// answers with a max_error, and impacts that are `near`. Impacts, and winding numbers of
    /// unknown containment, also depend on the C library.
    [[nodiscard]] CDPREP_API std::uint64_t state_hash() const noexcept;

private:
    struct State;
    struct Release {
        bool owns;
        void operator()(State* state) const noexcept;
    };
    explicit Scene(std::unique_ptr<State, Release> state) noexcept;
    static State* make(std::byte* memory, const Plan& plan) noexcept;

    std::unique_ptr<State, Release> state_;
};

}  // namespace cdprep
