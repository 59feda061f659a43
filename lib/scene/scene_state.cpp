// SPDX-License-Identifier: MIT
#include "scene/scene_state.h"

#include <cassert>
#include <utility>

#include "cdprep/format/float_environment.h"
#include "core/share_out.h"

namespace cdprep {

// Objects -----------------------------------------------------------------------------------------

ObjectSlot* Scene::State::find(ObjectId id) noexcept {
    if (id.slot >= plan->limits().objects || id.generation == 0) return nullptr;
    ObjectSlot& object = objects[id.slot];
    return object.model != nullptr && object.generation == id.generation ? &object : nullptr;
}

/// Stores the parts of the model of a slot. Models of layers without Rung::parts get none.
void Scene::State::find_parts(std::uint32_t slot) noexcept {
    if (parts == nullptr) return;
    const ObjectSlot& object = objects[slot];
    const bool is_asked = contains(plan->asks_of(object.layer), Ask::hulls);
    parts[slot] = is_asked ? enclosing_parts(*object.model) : EnclosingParts{};
}

void Scene::State::change(std::uint32_t slot) noexcept {
    if (!std::exchange(objects[slot].is_changed, true)) changed[changed_count++] = slot;
}

bool Scene::State::has_way(std::uint32_t slot) const noexcept {
    const ObjectSlot& object = objects[slot];
    if (last_poses == nullptr || (continuous_layers >> object.layer & 1) == 0) return false;
    const Pose& last_pose = last_poses[slot];
    return object.pose.rotation() != last_pose.rotation() ||
           object.pose.translation() != last_pose.translation();
}

/// Whether the model has changed since the last step. An object that was added may have the model
/// of the one that was in its slot.
bool Scene::State::has_new_shape(std::uint32_t slot) const noexcept {
    return shapes != nullptr && objects[slot].model->header().content_hash != shapes[slot];
}

/// Brings the box and the filter of a slot up to date.
void Scene::State::place(std::uint32_t slot) noexcept {
    const ObjectSlot& object = objects[slot];
    const bool is_there = object.model != nullptr;
    filters[slot] = is_there ? plan->filter_of(object.layer) : BoxFilter{0, 0};
    if (filters[slot].accepts == 0) {  // no other object is asked about it
        boxes[slot] = {{1, 1, 1}, {-1, -1, -1}};
        return;
    }
    const double reach = plan->reach_of(object.layer);
    roots[slot] = placed_box(*object.model, object.pose, reach);
    if (has_way(slot)) {
        roots[slot] = swept_box(placed_box(*object.model, last_poses[slot], reach), roots[slot]);
    }
    boxes[slot] = box_around(roots[slot], plan->origin());
}

void Scene::State::place_changed() noexcept {
    const format::FloatEnvironment environment;
    for (std::uint32_t slot = 0; changing_layers != 0 && slot < plan->limits().objects; ++slot) {
        const ObjectSlot& object = objects[slot];
        if (object.model == nullptr || (changing_layers >> object.layer & 1) == 0) continue;
        if (has_new_shape(slot)) change(slot);
    }
    for (std::uint32_t i = 0; i < changed_count; ++i) place(changed[i]);
}

// Candidates --------------------------------------------------------------------------------------

bool Scene::State::is_changed(const Record& record) const noexcept {
    if (record.is_of_one()) return has_new_shape(record.a.slot);
    return objects[record.a.slot].is_changed || objects[record.b.slot].is_changed;
}

void Scene::State::add_candidate(BoxPair slots) noexcept {
    const ObjectSlot &a = objects[slots.a], &b = objects[slots.b];
    if (next.haptic != nullptr) next.haptic[next.count] = HapticRecord();
    Record& record = next.record[next.count++];
    record = Record{.a = {slots.a, a.generation},
                    .b = {slots.b, b.generation},
                    .pair = *plan->find_pair(a.layer, b.layer),
                    .starts = {},
                    .is_new = true};
}

/// Returns the first slot from this one on whose object is asked about itself, or the number of
/// slots.
std::uint32_t Scene::State::next_self(std::uint32_t slot) const noexcept {
    const std::uint32_t count = plan->limits().objects;
    if (self_layers == 0) return count;
    const auto is_asked = [&](const ObjectSlot& object) {
        return object.model != nullptr && (self_layers >> object.layer & 1) != 0;
    };
    return static_cast<std::uint32_t>(std::find_if(objects + slot, objects + count, is_asked) -
                                      objects);
}

std::uint64_t Scene::State::self_count() const noexcept {
    std::uint64_t count = 0;
    const std::uint32_t end = plan->limits().objects;
    for (std::uint32_t slot = next_self(0); slot < end; slot = next_self(slot + 1)) ++count;
    return count;
}

/// Fills `next` with records of these pairs, and of objects that are asked about themselves. They
/// are in the order of slots. Returns how many there are. If they do not fit, there are none.
std::uint64_t Scene::State::list_candidates(std::span<const BoxPair> candidates) noexcept {
    next.count = 0;
    const std::uint64_t count = candidates.size() + self_count();
    if (count > plan->limits().pairs) return count;
    std::uint32_t slot = next_self(0);
    for (const BoxPair pair : candidates) {
        for (; slot <= pair.a; slot = next_self(slot + 1)) add_candidate({slot, slot});
        add_candidate(pair);
    }
    for (; slot < plan->limits().objects; slot = next_self(slot + 1)) add_candidate({slot, slot});
    return count;
}

/// Whether the slots have objects of paired layers whose boxes meet.
bool Scene::State::is_candidate(BoxPair slots) const noexcept {
    const std::uint32_t most = plan->limits().objects;
    if (slots.a >= slots.b || slots.b >= most) return false;
    const ObjectSlot &a = objects[slots.a], &b = objects[slots.b];
    if (a.model == nullptr || b.model == nullptr) return false;
    if ((filters[slots.a].accepts & filters[slots.b].layers) == 0) return false;
    const WorldBox &x = boxes[slots.a], &y = boxes[slots.b];
    for (int axis = 0; axis < 3; ++axis) {
        // The numbers of an absent box may lie between those of another.
        if (x.lower[axis] > x.upper[axis] || y.lower[axis] > y.upper[axis]) return false;
        if (x.lower[axis] > y.upper[axis] || y.lower[axis] > x.upper[axis]) return false;
    }
    return true;
}

/// Fills `next` with records of the candidates among the caller's pairs. Returns how many there
/// are; if they are more than fit, equal ones are counted again.
std::uint64_t Scene::State::list_given(std::span<const BoxPair> candidates) noexcept {
    const format::FloatEnvironment environment;
    std::uint64_t count = 0;
    next.count = 0;
    for (const auto [one, two] : candidates) {
        const BoxPair slots = {std::min(one, two), std::max(one, two)};
        if (!is_candidate(slots)) continue;
        if (count++ < plan->limits().pairs) add_candidate(slots);
    }
    count += self_count();
    if (count > plan->limits().pairs) return count;
    const std::uint32_t most = plan->limits().objects;
    for (std::uint32_t slot = next_self(0); slot < most; slot = next_self(slot + 1)) {
        add_candidate({slot, slot});
    }
    const auto end = next.record + next.count;
    const auto is_before = [](const Record& x, const Record& y) { return x.slots() < y.slots(); };
    const auto is_equal = [](const Record& x, const Record& y) { return x.slots() == y.slots(); };
    std::sort(next.record, end, is_before);
    next.count = static_cast<std::uint32_t>(std::unique(next.record, end, is_equal) - next.record);
    return next.count;
}

namespace {

/// A list that the next step copies from the last.
RecordList kept(const RecordList& list) noexcept {
    return {list.place, list.place, list.count};
}

}  // namespace

/// Takes over what the last step knew of two objects, as far as it is not paused.
void Scene::State::keep(std::uint32_t old, std::uint32_t now) noexcept {
    Record& record = next.record[now];
    record = last.record[old];
    record.is_new = false;
    record.called = Ask::nothing;
    record.asked = record.asked & effects_of(record);
    record.holds = record.holds & record.asked;
    if (next.collision) {
        next.collision[now] =
            contains(record.asked, Ask::collide) ? last.collision[old] : Collision();
    }
    if (next.triangle_list) {
        const bool is_asked = (record.asked & (Ask::overlap | Ask::self)) != Ask::nothing;
        next.triangle_list[now] = is_asked ? kept(last.triangle_list[old]) : RecordList();
    }
    if (next.contact_list) {
        const bool is_asked = contains(record.asked, Ask::contacts);
        next.contact_list[now] = is_asked ? kept(last.contact_list[old]) : RecordList();
    }
    if (next.distance) next.distance[now] = last.distance[old];
    if (next.impact) next.impact[now] = last.impact[old];
    if (next.verdict) next.verdict[now] = last.verdict[old];
}

/// Returns whether flags came from a distance with an error, and now are exact: it is paused.
bool Scene::State::follows_paused_distance(const Record& before, Ask effects) const noexcept {
    const bool had_error =
        plan->rungs()[before.pair].error > 0 && contains(before.asked, Ask::distance);
    return had_error && !contains(effects, Ask::distance) &&
           (effects & (Ask::collide | Ask::within)) != Ask::nothing;
}

/// Keeps the records of objects that have not changed, and lists the others to be asked.
void Scene::State::keep_known() noexcept {
    const format::FloatEnvironment environment;
    merge(last, next, [&](std::uint32_t old, std::uint32_t now) {
        if (old == last.count || now == next.count) return;
        const Record& before = last.record[old];
        Record& record = next.record[now];
        if (!record.is_same(before)) return;
        const bool is_known = contains(before.asked, effects_of(record)) &&
                              !follows_paused_distance(before, effects_of(record));
        if (is_known && !is_changed(record)) keep(old, now);
        record.starts = before.starts;
        if (next.haptic != nullptr) next.haptic[now] = last.haptic[old];
    });
    asked_count = 0;
    for (std::uint32_t i = 0; i < next.count; ++i) {
        if (next.record[i].is_new) asked[asked_count++] = i;
    }
}

// Queries -----------------------------------------------------------------------------------------

ListWriters Scene::State::start_lists(std::size_t worker) noexcept {
    ListWriters lists{};
    lists.clock = clock;
    lists.ticks = ticks[worker].data();
    if (triangle_pairs) lists.triangle_pairs = &triangle_pairs->writer(worker);
    if (contact_pages) {
        lists.contacts = &contact_pages->writer(worker);
        lists.contact_room = {contact_room + worker * most_contacts, most_contacts};
    }
    return lists;
}

void Scene::State::choose_kernels() noexcept {
    const std::span<const LayerPair> pairs = plan->pairs();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        kernels[i] = pair_kernel(without(effects_between(pairs[i]), paused));
    }
}

PairAnswer Scene::State::ask_two(std::uint32_t number, const ObjectSlot& a, const ObjectSlot& b,
                                 Workspace& workspace, const ListWriters& lists) noexcept {
    const Record& record = next.record[number];
    const LayerPair& asks = plan->pairs()[record.pair];
    const Pair pair{*a.model,
                    *b.model,
                    Placement::world(a.pose, b.pose),
                    {.body = asks.body, .overlap = asks.overlap}};
    const bool has_ways = last_poses != nullptr;
    const PairRung& rung = plan->rungs()[record.pair];
    PairQuestion question = {pair,
                             asks,
                             record.starts,
                             has_ways ? last_poses[record.a.slot] : a.pose,
                             has_ways ? last_poses[record.b.slot] : b.pose,
                             next.haptic != nullptr ? next.haptic + number : nullptr,
                             rung.error,
                             nullptr,
                             nullptr};
    if (rung.rung == Rung::parts) {
        const EnclosingParts &of_a = parts[record.a.slot], &of_b = parts[record.b.slot];
        // An object may have a model that the plan was not told.
        if (of_a.count > 0 && of_b.count > 0 && of_a.error + of_b.error <= rung.error) {
            question.parts_a = &of_a;
            question.parts_b = &of_b;
        }
    }
    return ask_pair(question, kernels[record.pair], workspace, lists);
}

/// Asks what the plan asks for.
void Scene::State::ask(std::uint32_t number, Workspace& workspace,
                       const ListWriters& lists) noexcept {
    const format::FloatEnvironment environment;
    Record& record = next.record[number];
    if (next.collision) next.collision[number] = {};
    if (next.triangle_list) next.triangle_list[number] = {};
    if (next.contact_list) next.contact_list[number] = {};
    record.asked = effects_of(record);
    if (record.asked == Ask::nothing) return;
    const ObjectSlot &a = objects[record.a.slot], &b = objects[record.b.slot];
    record.is_apart =
        !record.is_of_one() && !boxes_may_meet(roots[record.a.slot], roots[record.b.slot]);
    if (record.is_apart) return;
    const std::size_t first_pair = lists.triangle_pairs ? lists.triangle_pairs->begin_list() : 0;
    const std::size_t first_contact = lists.contacts ? lists.contacts->begin_list() : 0;
    const PairAnswer answer = record.is_of_one() ? ask_self(*a.model, workspace, lists)
                                                 : ask_two(number, a, b, workspace, lists);
    record.holds = answer.holds;
    record.called = answer.called;
    record.starts = answer.starts;
    if (next.collision) next.collision[number] = answer.collision;
    // A list that does not fit is longer than its count says; then the step is not complete.
    if (next.triangle_list) {
        next.triangle_list[number] = {first_pair, 0,
                                      static_cast<std::uint32_t>(answer.overlapping)};
    }
    if (next.contact_list) {
        next.contact_list[number] = {first_contact, 0,
                                     static_cast<std::uint32_t>(answer.contacts.count)};
    }
    if (next.distance) next.distance[number] = answer.distance;
    if (next.impact) next.impact[number] = answer.impact;
    if (next.verdict) next.verdict[number] = answer.contacts;
}

/// Prefetches what the search of `collide` reads first, because it is far away in memory.
void Scene::State::prefetch_search(std::uint32_t number) const noexcept {
    const Record& record = next.record[number];
    if (record.is_of_one() || record.starts.touched.a == kNoPair.a) return;
    prefetch_contact(record.starts.touched, *objects[record.a.slot].model,
                     *objects[record.b.slot].model);
}

void Scene::State::ask_all(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept {
    const std::size_t threads = std::min<std::size_t>(workspaces.size(), plan->limits().threads);
    if (triangle_pairs) triangle_pairs->start();
    if (contact_pages) contact_pages->start();
    std::fill_n(ticks, plan->limits().threads, EffectTicks{});
    const auto ask_share = [&](std::size_t first, std::size_t end, std::size_t worker) {
        for (std::size_t job = first; job < end; ++job) {
            // Another worker may be writing the record after the share.
            if (job + 1 < end) prefetch_search(asked[job + 1]);
            ask(asked[job], workspaces[worker], start_lists(worker));
        }
    };
    share_runs(asked_count, threads, parallel_for, ask_share);
}

// Lists -------------------------------------------------------------------------------------------

/// Gives each list its place in the order of records. Returns what the limits lack.
SceneStep Scene::State::place_lists() noexcept {
    const auto place_all = [&](RecordList* lists, std::uint64_t added) {
        std::uint32_t place = 0;
        for (std::uint32_t i = 0; lists != nullptr && i < next.count; ++i) {
            lists[i].place = std::exchange(place, place + lists[i].count);
            if (!next.record[i].is_new) added += lists[i].count;
        }
        return added;
    };
    const std::uint64_t pairs =
        place_all(next.triangle_list, triangle_pairs ? triangle_pairs->count() : 0);
    const std::uint64_t found =
        place_all(next.contact_list, contact_pages ? contact_pages->count() : 0);
    SceneStep step;
    if (pairs > plan->limits().triangle_pairs) step.needed_triangle_pairs = pairs;
    if (found > plan->limits().contacts) step.needed_contacts = found;
    step.complete = step.needed_triangle_pairs == 0 && step.needed_contacts == 0;
    return step;
}

namespace {

/// Brings the items of a record to their place.
template <class Item>
void fill_list(const RecordList& list, bool is_new, const ListPages<Item>& pages,
               const Item* last_items, Item* items) noexcept {
    if (list.count == 0) return;
    if (is_new) {
        pages.copy(list.source, list.count, items + list.place);
    } else {
        std::copy_n(last_items + list.source, list.count, items + list.place);
    }
}

}  // namespace

void Scene::State::fill_lists(std::size_t threads, ParallelFor parallel_for) noexcept {
    if (!triangle_pairs && !contact_pages) return;
    share_jobs(next.count, threads, parallel_for, [&](std::size_t job, std::size_t) {
        const bool is_new = next.record[job].is_new;
        if (next.triangle_list) {
            const RecordList& list = next.triangle_list[job];
            fill_list(list, is_new, *triangle_pairs, last.triangle_pairs, next.triangle_pairs);
            TrianglePair* const first = next.triangle_pairs + list.place;
            if (is_new) std::sort(first, first + list.count);
        }
        if (next.contact_list) {
            fill_list(next.contact_list[job], is_new, *contact_pages, last.contacts, next.contacts);
        }
    });
}

// Results -----------------------------------------------------------------------------------------

void Scene::State::count_calls() noexcept {
    counts = {.moved = changed_count, .candidates = next.count, .kept = next.count - asked_count};
    for (std::uint32_t i = 0; i < next.count; ++i) {
        const Record& record = next.record[i];
        if (next.triangle_list) counts.triangle_pairs += next.triangle_list[i].count;
        if (next.contact_list) counts.contacts += next.contact_list[i].count;
        if (!record.is_new) continue;
        counts.apart += record.is_apart ? 1 : 0;
        for (std::size_t effect = 0; effect < kSceneEffects.size(); ++effect) {
            counts.calls[effect] += contains(record.called, kSceneEffects[effect]) ? 1 : 0;
        }
    }
    for (std::uint32_t worker = 0; worker < plan->limits().threads; ++worker) {
        for (std::size_t i = 0; i < counts.ticks.size(); ++i) counts.ticks[i] += ticks[worker][i];
    }
    counts.box_ticks = box_ticks;
    counts.query_ticks = query_ticks;
}

EventReason Scene::State::reason_of(const Record& record, Ask effect,
                                    EventKind kind) const noexcept {
    const ObjectSlot &a = objects[record.a.slot], &b = objects[record.b.slot];
    const auto is_gone = [](const ObjectSlot& object, const ObjectId& id) {
        return object.model == nullptr || object.generation != id.generation;
    };
    const bool ends = kind == EventKind::ends;
    if (ends && (is_gone(a, record.a) || is_gone(b, record.b))) return EventReason::removed;
    if (a.layer != a.last_layer || b.layer != b.last_layer) return EventReason::relayered;
    if (contains(paused, effect) != contains(last_paused, effect)) return EventReason::paused;
    return kind == EventKind::stays && !is_changed(record) ? EventReason::unchanged
                                                           : EventReason::moved;
}

void Scene::State::add_events(const Record& record, Ask effects, EventKind kind) noexcept {
    if (effects == Ask::nothing) return;  // so it is for most records
    for (const Ask effect : kSceneEffects) {
        if (!contains(effects, effect)) continue;
        events[event_count++] = {record.a, record.b, record.pair,
                                 effect,   kind,     reason_of(record, effect, kind)};
    }
}

/// Lists what ends, stays and begins from the last step to the next.
void Scene::State::list_events() noexcept {
    event_count = 0;
    const Record none;
    merge(last, next, [&](std::uint32_t old, std::uint32_t now) {
        const Record& before = old < last.count ? last.record[old] : none;
        const Record& after = now < next.count ? next.record[now] : none;
        const Ask common = before.is_same(after) ? before.holds & after.holds : Ask::nothing;
        add_events(before, without(before.holds, common), EventKind::ends);
        if (common != Ask::nothing && plan->pairs()[after.pair].lists_stays) {
            add_events(after, common, EventKind::stays);
        }
        add_events(after, without(after.holds, common), EventKind::begins);
    });
}

/// Lists what is known of two objects, or of one, for which an effect holds.
void Scene::State::list_lists_of(std::uint32_t number) noexcept {
    const Record& record = last.record[number];
    const auto holds = [&](Ask effect) { return contains(record.holds, effect); };
    const auto triangles = [&] {
        const RecordList& list = last.triangle_list[number];
        return std::span<const TrianglePair>(last.triangle_pairs + list.place, list.count);
    };
    if (holds(Ask::distance)) {
        distances[distance_count++] = {record.a, record.b, record.pair, last.distance[number]};
    }
    if (holds(Ask::overlap)) {
        overlaps[overlap_count++] = {record.a, record.b, record.pair, triangles()};
    }
    if (holds(Ask::self)) {
        self_overlaps[self_overlap_count++] = {record.a, record.pair, triangles()};
    }
    if (holds(Ask::continuous)) {
        impacts[impact_count++] = {record.a, record.b, record.pair, last.impact[number]};
    }
    if (holds(Ask::haptic)) {
        const HapticRecord& haptic = last.haptic[number];
        bounded_distances[bounded_distance_count++] = {record.a, record.b, record.pair,
                                                       haptic.found, haptic.last};
    }
}

/// Lists the contacts of two objects, or that they were not found for lack of work.
void Scene::State::list_contacts_of(std::uint32_t number) noexcept {
    const Record& record = last.record[number];
    const RecordList& list = last.contact_list[number];
    const ContactsVerdict& verdict = last.verdict[number];
    if (list.count == 0 && verdict.searched) return;
    contacts[contact_count++] = {
        record.a, record.b, record.pair, {last.contacts + list.place, list.count}, verdict};
}

void Scene::State::list_results() noexcept {
    hit_count = distance_count = overlap_count = contact_count = 0;
    self_overlap_count = impact_count = bounded_distance_count = 0;
    for (std::uint32_t i = 0; i < last.count; ++i) {
        const Record& record = last.record[i];
        if (contains(record.asked, Ask::contacts) && !record.is_apart) list_contacts_of(i);
        const Collision collision = last.collision_of(i);
        if (record.holds == Ask::nothing && collision.hit == Answer::no) continue;
        hits[hit_count++] = {record.a, record.b, record.pair, record.holds, collision};
        list_lists_of(i);
    }
}

// A step ------------------------------------------------------------------------------------------

/// Forgets what has changed. An object that had a way is asked again in the next step, because it
/// has none there.
void Scene::State::accept_changes() noexcept {
    const format::FloatEnvironment environment;
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < changed_count; ++i) {
        const std::uint32_t slot = changed[i];
        ObjectSlot& object = objects[slot];
        object.is_changed = object.model != nullptr && has_way(slot);
        object.last_layer = object.layer;
        if (object.is_changed) changed[left++] = slot;
        if (object.model == nullptr) continue;
        if (last_poses != nullptr) last_poses[slot] = object.pose;
        if (shapes != nullptr) shapes[slot] = object.model->header().content_hash;
    }
    changed_count = left;
    last_paused = paused;
}

/// Computes a step from the candidates in `next`. `begin` is the time at which the step began: each
/// stage begins where the last one ends, so that their ticks make up the step.
SceneStep Scene::State::compute(std::uint64_t begin, std::span<Workspace> workspaces,
                                ParallelFor parallel_for) noexcept {
    keep_known();
    choose_kernels();
    const std::uint64_t queries_begin = now();
    box_ticks = queries_begin - begin;
    ask_all(workspaces, parallel_for);
    const std::uint64_t lists_begin = now();
    query_ticks = lists_begin - queries_begin;
    const SceneStep step = place_lists();
    if (!step.complete) return step;
    fill_lists(std::min<std::size_t>(workspaces.size(), plan->limits().threads), parallel_for);
    count_calls();
    list_events();
    std::swap(last, next);
    list_results();
    accept_changes();
    counts.list_ticks = now() - lists_begin;
    return step;
}

SceneStep Scene::State::step(std::span<Workspace> workspaces, ParallelFor parallel_for) noexcept {
    const std::uint64_t begin = now();
    place_changed();
    const std::size_t size = plan->limits().objects;
    const BroadPhaseUpdate candidates =
        broad_phase_is_late ? broad_phase->update({boxes, size}, {filters, size}, parallel_for)
                            : broad_phase->update_moved({boxes, size}, {filters, size},
                                                        {changed, changed_count}, parallel_for);
    assert(!candidates.refused);  // box_around() returns no NaN
    broad_phase_is_late = false;
    if (!candidates.complete) {
        return {.complete = false, .needed_pairs = candidates.needed + self_count()};
    }
    const std::uint64_t count = list_candidates(candidates.pairs);
    if (count > plan->limits().pairs) return {.complete = false, .needed_pairs = count};
    return compute(begin, workspaces, parallel_for);
}

SceneStep Scene::State::step_with(std::span<const BoxPair> candidates,
                                  std::span<Workspace> workspaces,
                                  ParallelFor parallel_for) noexcept {
    const std::uint64_t begin = now();
    place_changed();
    const std::uint64_t count = list_given(candidates);
    if (count > plan->limits().pairs) return {.complete = false, .needed_pairs = count};
    const SceneStep step = compute(begin, workspaces, parallel_for);
    broad_phase_is_late = true;
    return step;
}

}  // namespace cdprep
