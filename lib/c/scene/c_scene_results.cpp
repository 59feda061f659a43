// SPDX-License-Identifier: MIT
#include <cstddef>
#include <optional>
#include <span>

#include "c/c_contacts.h"
#include "c/c_workspace.h"
#include "c/pair_answers.h"
#include "c/pose_input.h"
#include "c/scene/c_scene.h"

namespace cdprep::c {
namespace {

static_assert(CDPREP_REASON_MOVED == static_cast<int>(EventReason::moved) &&
              CDPREP_REASON_REMOVED == static_cast<int>(EventReason::removed) &&
              CDPREP_REASON_RELAYERED == static_cast<int>(EventReason::relayered) &&
              CDPREP_REASON_PAUSED == static_cast<int>(EventReason::paused) &&
              CDPREP_REASON_UNCHANGED == static_cast<int>(EventReason::unchanged));

/// Returns the index of the ticks of an effect in counts.
constexpr std::size_t ticks_of(Ask effect) noexcept {
    switch (effect) {
        case Ask::collide:
            return CDPREP_SCENE_TICKS_COLLIDE;
        case Ask::overlap:
            return CDPREP_SCENE_TICKS_OVERLAP;
        case Ask::within:
            return CDPREP_SCENE_TICKS_WITHIN;
        case Ask::distance:
            return CDPREP_SCENE_TICKS_DISTANCE;
        case Ask::contacts:
            return CDPREP_SCENE_TICKS_CONTACTS;
        case Ask::continuous:
            return CDPREP_SCENE_TICKS_CONTINUOUS;
        case Ask::self:
            return CDPREP_SCENE_TICKS_SELF;
        default:
            return CDPREP_SCENE_TICKS_HAPTIC;
    }
}

cdprep_object as_c(const ObjectId& id) noexcept {
    return {id.slot, id.generation};
}

cdprep_scene_hit as_c(const SceneHit& hit, std::uint32_t layer_pair) noexcept {
    return {as_c(hit.a), as_c(hit.b), layer_pair, static_cast<std::uint32_t>(hit.holds),
            in_c(hit.collision.hit == Answer::yes, hit.collision.containment)};
}

static_assert(kNoTriangleNumber == CDPREP_NONE);

cdprep_scene_distance as_c(const SceneDistance& found, std::uint32_t layer_pair) noexcept {
    return {as_c(found.a), as_c(found.b), layer_pair, 0, in_c(std::optional(found.distance))};
}

cdprep_scene_impact as_c(const SceneImpact& found, std::uint32_t layer_pair) noexcept {
    return {as_c(found.a), as_c(found.b), layer_pair, 0, in_c(found.impact)};
}

cdprep_scene_bounded as_c(const SceneBoundedDistance& found, std::uint32_t layer_pair) noexcept {
    const LastDistance& last = found.last;
    cdprep_scene_bounded to = {as_c(found.a),
                               as_c(found.b),
                               layer_pair,
                               word(last.is_known),
                               last.late,
                               in_c(found.distance),
                               in_c(last.distance),
                               {},
                               {}};
    to.last_pose_a = stored(last.placement.pose_a());
    to.last_pose_b = stored(last.placement.pose_b());
    return to;
}

std::uint32_t as_c(EventKind kind) noexcept {
    if (kind == EventKind::begins) return CDPREP_EVENT_BEGIN;
    return kind == EventKind::stays ? CDPREP_EVENT_STAY : CDPREP_EVENT_END;
}

const cdprep_overlap* as_c(std::span<const TrianglePair> triangles) noexcept {
    // The two types have the same members.
    static_assert(sizeof(TrianglePair) == sizeof(cdprep_overlap) &&
                  offsetof(TrianglePair, a) == offsetof(cdprep_overlap, a) &&
                  offsetof(TrianglePair, b) == offsetof(cdprep_overlap, b));
    return reinterpret_cast<const cdprep_overlap*>(triangles.data());
}

cdprep_scene_overlap as_c(const SceneOverlaps& found, std::uint32_t layer_pair) noexcept {
    return {as_c(found.a),         as_c(found.b),         layer_pair, 0,
            as_c(found.triangles), found.triangles.size()};
}

cdprep_scene_self_overlap as_c(const SceneSelfOverlaps& found, std::uint32_t layer_pair) noexcept {
    return {as_c(found.object), layer_pair, 0, as_c(found.triangles), found.triangles.size()};
}

/// `items` is where the contacts are.
cdprep_scene_contact as_c(const SceneContacts& found, std::uint32_t layer_pair,
                          const cdprep_contact* items) noexcept {
    const ContactsVerdict& verdict = found.verdict;
    return {as_c(found.a),
            as_c(found.b),
            layer_pair,
            word(verdict.complete),
            word(verdict.searched),
            0,
            items,
            found.contacts.size(),
            verdict.found,
            verdict.computed,
            verdict.work};
}

cdprep_event as_c(const SceneEvent& event, std::uint32_t layer_pair) noexcept {
    return {as_c(event.a),    as_c(event.b),
            layer_pair,       static_cast<std::uint32_t>(event.effect),
            as_c(event.kind), static_cast<std::uint32_t>(event.reason)};
}

/// Copies a stream. Returns the number of its elements.
template <class From, class To>
std::size_t store(const cdprep_plan& plan, std::span<const From> from, To* to) noexcept {
    for (const From& one : from) *to++ = as_c(one, plan.given_as[one.pair]);
    return from.size();
}

std::size_t store_contacts(const cdprep_plan& plan, std::span<const SceneContacts> from,
                           cdprep_scene_contact* to, cdprep_contact* items) noexcept {
    for (const SceneContacts& found : from) {
        *to++ = as_c(found, plan.given_as[found.pair], items);
        for (const Contact& contact : found.contacts) *items++ = in_c(contact);
    }
    return from.size();
}

/// Stores the address of an array of results in `*items`.
template <class T>
int read_stream(const cdprep_scene* scene, const char* name, const T** items, std::size_t* count,
                cdprep_error* error, T* SceneResults::*array,
                std::size_t SceneResults::*array_count) noexcept {
    Call call(error);
    if (items != nullptr) *items = nullptr;
    if (count != nullptr) *count = 0;
    if (const int code = call.need(scene, {"scene"})) return code;
    if (const int code = call.need(items, {name})) return code;
    if (const int code = call.need(count, {"count"})) return code;
    if (const int code = check_free(call, {"scene"}, scene->in_use)) return code;
    *items = scene->results.*array;
    *count = scene->results.*array_count;
    return CDPREP_OK;
}

}  // namespace

void store_results(cdprep_scene& scene) noexcept {
    SceneResults& results = scene.results;
    results.hit_count = store(*scene.plan, scene.scene.hits(), results.hits);
    results.overlap_count = store(*scene.plan, scene.scene.overlaps(), results.overlaps);
    results.distance_count = store(*scene.plan, scene.scene.distances(), results.distances);
    results.contact_count = store_contacts(*scene.plan, scene.scene.contacts(), results.contacts,
                                           results.contact_items);
    results.event_count = store(*scene.plan, scene.scene.events(), results.events);
    results.self_overlap_count =
        store(*scene.plan, scene.scene.self_overlaps(), results.self_overlaps);
    results.impact_count = store(*scene.plan, scene.scene.impacts(), results.impacts);
    results.bounded_distance_count =
        store(*scene.plan, scene.scene.bounded_distances(), results.bounded_distances);
}

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::read_stream;
using cdprep::c::SceneResults;

int cdprep_scene_hits(const cdprep_scene* scene, const cdprep_scene_hit** hits, size_t* count,
                      cdprep_error* error) {
    return read_stream(scene, "hits", hits, count, error, &SceneResults::hits,
                       &SceneResults::hit_count);
}

int cdprep_scene_overlaps(const cdprep_scene* scene, const cdprep_scene_overlap** overlaps,
                          size_t* count, cdprep_error* error) {
    return read_stream(scene, "overlaps", overlaps, count, error, &SceneResults::overlaps,
                       &SceneResults::overlap_count);
}

int cdprep_scene_distances(const cdprep_scene* scene, const cdprep_scene_distance** distances,
                           size_t* count, cdprep_error* error) {
    return read_stream(scene, "distances", distances, count, error, &SceneResults::distances,
                       &SceneResults::distance_count);
}

int cdprep_scene_contacts(const cdprep_scene* scene, const cdprep_scene_contact** contacts,
                          size_t* count, cdprep_error* error) {
    return read_stream(scene, "contacts", contacts, count, error, &SceneResults::contacts,
                       &SceneResults::contact_count);
}

int cdprep_scene_events(const cdprep_scene* scene, const cdprep_event** events, size_t* count,
                        cdprep_error* error) {
    return read_stream(scene, "events", events, count, error, &SceneResults::events,
                       &SceneResults::event_count);
}

int cdprep_scene_self_overlaps(const cdprep_scene* scene,
                               const cdprep_scene_self_overlap** overlaps, size_t* count,
                               cdprep_error* error) {
    return read_stream(scene, "overlaps", overlaps, count, error, &SceneResults::self_overlaps,
                       &SceneResults::self_overlap_count);
}

int cdprep_scene_impacts(const cdprep_scene* scene, const cdprep_scene_impact** impacts,
                         size_t* count, cdprep_error* error) {
    return read_stream(scene, "impacts", impacts, count, error, &SceneResults::impacts,
                       &SceneResults::impact_count);
}

int cdprep_scene_bounded_distances(const cdprep_scene* scene,
                                   const cdprep_scene_bounded** distances, size_t* count,
                                   cdprep_error* error) {
    return read_stream(scene, "distances", distances, count, error,
                       &SceneResults::bounded_distances, &SceneResults::bounded_distance_count);
}

int cdprep_scene_hash(const cdprep_scene* scene, uint64_t* hash, cdprep_error* error) {
    Call call(error);
    if (hash != nullptr) *hash = 0;
    if (const int code = call.need(scene, {"scene"})) return code;
    if (const int code = call.need(hash, {"hash"})) return code;
    if (const int code = check_free(call, {"scene"}, scene->in_use)) return code;
    *hash = scene->scene.state_hash();
    return CDPREP_OK;
}

int cdprep_scene_counts(const cdprep_scene* scene, cdprep_counts* counts, cdprep_error* error) {
    Call call(error);
    if (counts != nullptr) *counts = {};
    if (const int code = call.need(scene, {"scene"})) return code;
    if (const int code = call.need(counts, {"counts"})) return code;
    if (const int code = check_free(call, {"scene"}, scene->in_use)) return code;
    const cdprep::SceneCounts& all = scene->scene.counts();
    counts->n[CDPREP_SCENE_OBJECTS] = scene->scene.object_count();
    counts->n[CDPREP_SCENE_MOVED] = all.moved;
    counts->n[CDPREP_SCENE_CANDIDATES] = all.candidates;
    counts->n[CDPREP_SCENE_KEPT] = all.kept;
    counts->n[CDPREP_SCENE_APART] = all.apart;
    counts->n[CDPREP_SCENE_COLLIDE] = all.calls_of(cdprep::Ask::collide);
    counts->n[CDPREP_SCENE_WITHIN] = all.calls_of(cdprep::Ask::within);
    counts->n[CDPREP_SCENE_DISTANCE] = all.calls_of(cdprep::Ask::distance);
    counts->n[CDPREP_SCENE_OVERLAP] = all.calls_of(cdprep::Ask::overlap);
    counts->n[CDPREP_SCENE_TRIANGLE_PAIRS] = all.triangle_pairs;
    counts->n[CDPREP_SCENE_CONTACTS] = all.calls_of(cdprep::Ask::contacts);
    counts->n[CDPREP_SCENE_LISTED_CONTACTS] = all.contacts;
    counts->n[CDPREP_SCENE_CONTINUOUS] = all.calls_of(cdprep::Ask::continuous);
    counts->n[CDPREP_SCENE_SELF] = all.calls_of(cdprep::Ask::self);
    counts->n[CDPREP_SCENE_HAPTIC] = all.calls_of(cdprep::Ask::haptic);
    for (std::size_t i = 0; i < cdprep::kSceneEffects.size(); ++i) {
        counts->n[cdprep::c::ticks_of(cdprep::kSceneEffects[i])] = all.ticks[i];
    }
    counts->n[CDPREP_SCENE_TICKS_BOXES] = all.box_ticks;
    counts->n[CDPREP_SCENE_TICKS_QUERIES] = all.query_ticks;
    counts->n[CDPREP_SCENE_TICKS_LISTS] = all.list_ticks;
    return CDPREP_OK;
}
