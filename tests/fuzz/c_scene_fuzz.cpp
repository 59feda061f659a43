// SPDX-License-Identifier: MIT
// Plans and scenes of the C API, with hostile arguments in any order.
//
// A list of what was added is kept beside the scene. What is refused must change nothing. After a
// step that is complete, single queries of all pairs are the oracle.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <vector>

#include "hostile_input.h"

#include "cdprep/cdprep.h"

namespace {

using namespace cdprep::test;  // NOLINT(google-build-using-namespace): a program of its own

constexpr std::uint32_t kMostObjects = 7;
constexpr std::uint32_t kLayersUsed = 3;
constexpr std::uint32_t kSceneAsks = CDPREP_ASK_COLLIDE | CDPREP_ASK_OVERLAP | CDPREP_ASK_WITHIN |
                                     CDPREP_ASK_DISTANCE | CDPREP_ASK_CONTACTS |
                                     CDPREP_ASK_CONTINUOUS | CDPREP_ASK_SELF | CDPREP_ASK_DEFORM |
                                     CDPREP_ASK_TEAR | CDPREP_ASK_HAPTIC;
constexpr std::size_t kRoom = 1 << 16;
/// Of the lengths in poses, but 0. Where others are valid, exact arithmetic decides each pair of
/// triangles, because objects are tiny beside their places or almost the same: that takes seconds.
constexpr double kLeast = 1e-6, kMost = 1000;

std::uint32_t draw_effects(Draw& draw) {
    return (draw.byte() | draw.below(8) << 8) & kSceneAsks;
}

/// The options of a plan, and what they point to.
class PlanInput {
public:
    PlanInput(Draw& draw, const Models& models, bool is_hostile) {
        cdprep_plan_options_init(&options_.value, sizeof options_.value);
        cdprep_plan_options& o = options_.value;
        o.layer_pair_count = 1 + draw.below(kMostPairs);
        for (std::uint32_t i = 0; i < o.layer_pair_count; ++i) draw_pair(draw, i);
        if (is_hostile && draw.one_in(2)) spoil_pair(draw, pairs[draw.below(o.layer_pair_count)]);
        o.layer_pairs = pairs.data();
        o.max_objects = draw.one_in(4) ? draw.below(kMostObjects) : kMostObjects;
        o.max_pairs = draw.one_in(3) ? draw.below(40) : 100;
        o.max_triangle_pairs = draw.one_in(4) ? draw.byte() : 30000;
        o.max_contacts = draw.one_in(4) ? draw.byte() : 1000;
        o.lanes = 1 + draw.below(3);
        if (draw.one_in(3)) name_layers(draw, is_hostile);
        if (!is_hostile) return;
        if (draw.one_in(2)) use_model(draw, models);
        if (draw.one_in(4)) (&o.layer_pair_count)[draw.below(8)] = draw.word();
        // A count above that of the array is a lie about memory.
        o.layer_pair_count =
            o.layer_pair_count > 528 ? 529 : std::min(o.layer_pair_count, kMostPairs);
        o.model_count = std::min(o.model_count, 1U);
        o.layer_name_count = o.layer_name_count > 32 ? 33 : std::min(o.layer_name_count, 2U);
        o.max_objects = o.max_objects > 1U << 29 ? o.max_objects : o.max_objects % 50;
        o.max_pairs %= 1000;
        o.max_triangle_pairs %= 30001;
        o.max_contacts %= 1001;
        options_.spoil(draw);
    }
    [[nodiscard]] const cdprep_plan_options* get() const {
        return &options_.value;
    }

    static constexpr std::uint32_t kMostPairs = 5;
    std::array<cdprep_layer_pair, kMostPairs> pairs{};

private:
    void draw_pair(Draw& draw, std::uint32_t number) {
        cdprep_layer_pair& pair = pairs[number];
        cdprep_layer_pair_init(&pair, sizeof pair);
        // Each pair of layers once.
        constexpr std::array<std::array<std::uint32_t, 2>, kMostPairs> kLayers = {
            {{0, 1}, {2, 1}, {0, 0}, {1, 1}, {2, 2}}};
        pair.a = kLayers[number][0];
        pair.b = kLayers[number][1];
        pair.effects = draw_effects(draw);
        const auto asks = [&](std::uint32_t some) { return (pair.effects & some) != 0; };
        if (pair.a != pair.b) pair.effects &= ~std::uint32_t{CDPREP_ASK_SELF};
        if (asks(CDPREP_ASK_HAPTIC)) pair.effects &= ~std::uint32_t{CDPREP_ASK_DISTANCE};
        if (asks(CDPREP_ASK_DEFORM | CDPREP_ASK_TEAR)) {
            pair.effects &= ~std::uint32_t{CDPREP_ASK_CONTACTS | CDPREP_ASK_CONTINUOUS};
        }
        pair.lists_stays = draw.below(2);
        if (asks(CDPREP_ASK_COLLIDE | CDPREP_ASK_DISTANCE | CDPREP_ASK_CONTACTS |
                 CDPREP_ASK_CONTINUOUS) &&
            !asks(CDPREP_ASK_HAPTIC)) {
            pair.body = draw.below(2);
        }
        if (asks(CDPREP_ASK_COLLIDE | CDPREP_ASK_OVERLAP)) pair.overlap = draw.below(2);
        if (asks(CDPREP_ASK_WITHIN)) pair.tolerance = draw.byte() / 128.0;
        if (asks(CDPREP_ASK_DISTANCE | CDPREP_ASK_HAPTIC)) pair.max_distance = draw.byte() / 64.0;
        if (asks(CDPREP_ASK_HAPTIC)) pair.work = 1 + 16 * draw.byte();
        if (asks(CDPREP_ASK_CONTINUOUS)) {
            pair.impact_tolerance = (1 + draw.byte()) / 256.0;
            pair.impact_steps = 1 + draw.below(40);
        }
        if (!asks(CDPREP_ASK_CONTACTS) || draw.one_in(3)) return;
        cdprep_contact_options& contacts = contacts_[number];
        cdprep_contact_options_init(&contacts, sizeof contacts);
        contacts.tolerance = draw.byte() / 256.0;
        contacts.manifold = draw.below(2) * 4;
        contacts.most = 1 + draw.byte();
        if (draw.one_in(2)) contacts.work = draw.byte();
        if (draw.one_in(2)) contacts.cluster_angle = draw.byte() / 128.0;
        pair.contacts = &contacts;
    }
    void spoil_pair(Draw& draw, cdprep_layer_pair& pair) {
        if (draw.one_in(3)) (&pair.a)[draw.below(6)] = draw.word();
        if (draw.one_in(3)) pair.tolerance = draw.number();
        if (draw.one_in(3)) pair.max_distance = draw.number();
        if (draw.one_in(3)) pair.impact_tolerance = draw.number();
        if (draw.one_in(3)) pair.impact_steps = draw.word();
        if (draw.one_in(3)) pair.work = draw.word();
        if (draw.one_in(8)) pair.head.tag = draw.word();
        if (!draw.one_in(3)) return;
        contacts_[0].tolerance = draw.number();
        contacts_[0].cluster_angle = draw.number();
        contacts_[0].most = draw.word();
        contacts_[0].manifold = draw.word();
        pair.contacts = contacts_.data();
    }
    void name_layers(Draw& draw, bool is_hostile) {
        names_ = {"floor", is_hostile && draw.one_in(3) ? nullptr : ""};
        options_.value.layer_names = names_.data();
        options_.value.layer_name_count = draw.below(3);
    }
    void use_model(Draw& draw, const Models& models) {
        cdprep_model_use_init(&use_.value, sizeof use_.value);
        use_.value.model = models.any(draw);
        if (draw.one_in(2)) use_.value.serves = draw.word();
        if (draw.one_in(4)) use_.value.name = "a model";
        use_.value.layers = draw.word();
        use_.spoil(draw);
        options_.value.models = &use_.value;
        options_.value.model_count = 1;
    }

    Longer<cdprep_plan_options> options_{};
    Longer<cdprep_model_use> use_{};
    std::array<cdprep_contact_options, kMostPairs> contacts_{};
    std::array<const char*, 2> names_{};
};

int count_sentence(void* count, const char* sentence) {
    MUST(sentence[0] != 0);
    return ++*static_cast<int*>(count) % 3;
}

/// An object as it was added or changed last.
struct Added {
    std::uint32_t generation;
    const cdprep_model* model;
    std::uint32_t layer;
    cdprep_pose pose;
};

/// The next result of a stream, if it is that of two objects.
template <class Result>
const Result* take(std::span<const Result>& stream, const cdprep_object& a,
                   const cdprep_object& b) {
    if (stream.empty()) return nullptr;
    const Result& next = stream.front();
    if (std::memcmp(&next.a, &a, sizeof a) != 0 || std::memcmp(&next.b, &b, sizeof b) != 0) {
        return nullptr;
    }
    stream = stream.subspan(1);
    return &next;
}

/// A scene beside a plain list of its objects.
class World {
public:
    World(Draw& draw, const Models& models)
        : draw_(draw), models_(models), lanes_(1 + draw.below(3)), input_(draw, models, false) {
        cdprep_plan* plan = nullptr;
        MUST(is_answered(cdprep_plan_compile(input_.get(), nullptr, nullptr, &plan, &error_),
                         error_));
        for (std::uint32_t layer = 0; layer < kLayersUsed; ++layer) {
            MUST(cdprep_plan_ask(plan, layer, &asks_[layer], nullptr) == CDPREP_OK);
        }
        std::size_t size = 0;
        MUST(is_answered(cdprep_scene_size(plan, &size, &error_), error_));
        if (draw.one_in(4)) {
            MUST(cdprep_scene_make(plan, nullptr, 0, &scene_, &error_) == CDPREP_OK);
        } else {
            memory_ = AlignedBytes(size);
            std::memset(memory_.span().data(), draw.byte(), size);
            MUST(cdprep_scene_make(plan, memory_.span().data(), size, &scene_, &error_) ==
                 CDPREP_OK);
        }
        cdprep_plan_end(plan);
        for (std::uint32_t adds = draw.below(kMostObjects); adds > 0; --adds) add();
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    ~World() {
        cdprep_scene_end(scene_);
    }

    void call() {
        switch (draw_.below(10)) {
            case 0:
            case 1:
            case 2:
                add();
                break;
            case 3:
                remove();
                break;
            case 4:
                set_layer();
                break;
            case 5:
                set_poses(cdprep_scene_put);
                break;
            case 6:
                set_poses(cdprep_scene_set_poses);
                break;
            case 7:
                pause();
                break;
            default:
                step();
        }
        cdprep_counts counts;
        MUST(is_answered(cdprep_scene_counts(scene_, &counts, &error_), error_));
        MUST(counts.n[CDPREP_SCENE_OBJECTS] == objects_.size());
        describe();
    }

private:
    [[nodiscard]] std::uint32_t max_objects() const {
        return input_.get()->max_objects;
    }
    /// What the scene says of an object, and a picture of all.
    void describe() {
        const cdprep_object id = any_id();
        cdprep_object_info info{};
        cdprep_object found = {77, 77};
        if (is_answered(cdprep_scene_describe(scene_, id, &info, &error_), error_)) {
            const auto& object = objects_.at(id.slot);
            MUST(exists(id) && info.model == object.model && info.layer == object.layer);
            MUST(std::memcmp(&info.world_from_model, &object.pose, sizeof object.pose) == 0);
        } else {
            MUST(!exists(id) && info.model == nullptr);
        }
        if (is_answered(cdprep_scene_object_at(scene_, id.slot, &found, &error_), error_)) {
            MUST((found.generation != 0) == objects_.contains(id.slot));
            MUST(found.generation == 0 || exists(found));
        } else {
            MUST(found.generation == 0 && id.slot >= max_objects());
        }
        std::size_t shapes = 0;
        Longer<cdprep_draw> given{};
        cdprep_draw_init(&given.value, sizeof given.value);
        cdprep_draw& d = given.value;
        d.what = draw_.one_in(8) ? draw_.word() : draw_.below(128);
        d.context = &shapes;
        d.line = [](void* to, const double* start, const double* /*end*/, std::uint32_t /*rgba*/) {
            MUST(std::isfinite(start[0]));
            return ++*static_cast<std::size_t*>(to) < 500 ? 1 : 0;
        };
        d.triangle = [](void* to, const double* corners, std::uint32_t /*rgba*/) {
            MUST(std::isfinite(corners[8]));
            return ++*static_cast<std::size_t*>(to) < 500 ? 1 : 0;
        };
        d.label = [](void* to, const double* at, const char* /*text*/, std::uint32_t /*rgba*/) {
            MUST(std::isfinite(at[2]));
            return ++*static_cast<std::size_t*>(to) < 500 ? 1 : 0;
        };
        given.spoil(draw_);
        if (!is_answered(cdprep_scene_draw(scene_, &d, &error_), error_)) MUST(shapes == 0);
        MUST(shapes <= 500);
    }
    /// An id that exists, or any.
    cdprep_object any_id() {
        if (objects_.empty() || draw_.one_in(6)) return {draw_.below(9), draw_.word()};
        const auto at =
            std::next(objects_.begin(), draw_.below(static_cast<std::uint32_t>(objects_.size())));
        return {at->first, at->second.generation};
    }
    [[nodiscard]] bool exists(const cdprep_object& id) const {
        const auto at = objects_.find(id.slot);
        return at != objects_.end() && at->second.generation == id.generation;
    }
    [[nodiscard]] bool serves(const cdprep_model* model, std::uint32_t layer) const {
        return cdprep_model_serves(model, asks_[layer], nullptr) == CDPREP_OK;
    }

    /// A model that mostly serves the layer.
    const cdprep_model* any_model(std::uint32_t layer) {
        const cdprep_model* model = nullptr;
        for (int tries = 0; tries < 6 && (model == nullptr || !serves(model, layer)); ++tries) {
            model = models_.any(draw_);
        }
        return model;
    }
    void add() {
        std::array<cdprep_object_options, 2> given;
        std::array<cdprep_object, 2> ids = {{{77, 77}, {77, 77}}};
        const std::uint32_t count = draw_.one_in(4) ? 2 : 1;
        bool is_valid = objects_.size() + count <= max_objects();
        for (cdprep_object_options& one : given) {
            cdprep_object_options_init(&one, sizeof one);
            one.layer = draw_.below(kLayersUsed);
            one.model = any_model(one.layer);
            draw_place(one.world_from_model);
            if (draw_.one_in(20)) one.layer = draw_.word();
            if (draw_.one_in(40)) one.reserved = draw_.word();
            if (draw_.one_in(40)) one.head.tag = draw_.word();
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            is_valid = is_valid && given[i].model != nullptr && given[i].layer < kLayersUsed &&
                       serves(given[i].model, given[i].layer) && is_rigid(given[i]);
        }
        const int code = cdprep_scene_add(scene_, given.data(), count, ids.data(), &error_);
        if (!is_answered(code, error_)) {
            MUST(!is_valid || given[0].reserved != 0 || given[1].reserved != 0 ||
                 error_.why == CDPREP_WHY_NOT_INITIALISED);
            for (std::uint32_t i = 0; i < count; ++i) MUST(ids[i].generation == 0);
            return;
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            MUST(ids[i].generation != 0 && ids[i].slot < max_objects() &&
                 !objects_.contains(ids[i].slot));
            objects_[ids[i].slot] = {ids[i].generation, given[i].model, given[i].layer,
                                     given[i].world_from_model};
        }
    }
    static bool is_rigid(const cdprep_object_options& object) {
        cdprep_pose moved;
        const cdprep_pose identity = {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}};
        return cdprep_pose_compose(&object.world_from_model, &identity, &moved, nullptr) ==
               CDPREP_OK;
    }
    /// A pose with lengths in that range, or one that is refused.
    void draw_place(cdprep_pose& pose) {
        cdprep_pose drawn = pose;
        draw_pose(draw_, drawn);
        for (std::size_t i = 9; i < 12; ++i) {
            const double length = std::fabs(drawn.rows[i]);
            if (std::isfinite(length) && (length > kMost || (length > 0 && length < kLeast))) {
                return;
            }
        }
        pose = drawn;
    }
    void remove() {
        const std::array<cdprep_object, 2> ids = {any_id(), any_id()};
        const std::uint32_t count = draw_.below(3);
        const auto is_stale = [&](std::uint32_t i) { return i < count && !exists(ids[i]); };
        const bool is_valid = !is_stale(0) && !is_stale(1);
        MUST(is_answered(cdprep_scene_remove(scene_, ids.data(), count, &error_), error_) ==
             is_valid);
        for (std::uint32_t i = 0; i < count && is_valid; ++i) objects_.erase(ids[i].slot);
    }
    void set_layer() {
        const cdprep_object id = any_id();
        const std::uint32_t layer = draw_.one_in(10) ? draw_.word() : draw_.below(kLayersUsed);
        const int code = cdprep_scene_set_layer(scene_, id, layer, &error_);
        if (!is_answered(code, error_)) {
            MUST(!exists(id) || layer >= kLayersUsed || !serves(objects_.at(id.slot).model, layer));
            return;
        }
        MUST(exists(id));
        // Layers that nothing asks for serve as well.
        objects_[id.slot].layer = layer;
    }
    using SetPoses = int (*)(cdprep_scene*, const cdprep_object*, const cdprep_pose*, std::size_t,
                             cdprep_error*);
    void set_poses(SetPoses function) {
        const std::array<cdprep_object, 2> ids = {any_id(), any_id()};
        std::array<cdprep_pose, 2> poses = {
            {{{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}}, {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}}}};
        for (cdprep_pose& pose : poses) draw_place(pose);
        const std::uint32_t count = draw_.below(3);
        const int code = function(scene_, ids.data(), poses.data(), count, &error_);
        if (!is_answered(code, error_)) return;
        for (std::uint32_t i = 0; i < count; ++i) {
            MUST(exists(ids[i]));
            objects_[ids[i].slot].pose = poses[i];
        }
    }
    void pause() {
        const std::uint32_t effects = draw_.one_in(4) ? draw_.word() : draw_effects(draw_);
        if (is_answered(cdprep_scene_set_paused(scene_, effects, &error_), error_)) {
            paused_ = effects;
        }
    }

    /// All pairs of slots with objects, or some wrong ones.
    std::vector<cdprep_box_pair> candidates(bool is_hostile) {
        std::vector<cdprep_box_pair> pairs;
        for (const auto& [a, one] : objects_) {
            for (const auto& [b, two] : objects_) {
                if (a < b) pairs.push_back({a, b});
            }
        }
        if (!is_hostile) return pairs;
        for (std::uint32_t i = draw_.below(3); i > 0; --i) {
            const cdprep_box_pair pair = {draw_.one_in(4) ? draw_.word() : draw_.below(8),
                                          draw_.one_in(4) ? draw_.word() : draw_.below(8)};
            pairs.insert(pairs.begin() + draw_.below(static_cast<std::uint32_t>(pairs.size()) + 1),
                         pair);
        }
        if (!pairs.empty() && draw_.one_in(2)) pairs.erase(pairs.begin());
        return pairs;
    }
    [[nodiscard]] bool are_valid(const std::vector<cdprep_box_pair>& pairs) const {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto [a, b] = pairs[i];
            if (a >= b || !objects_.contains(a) || !objects_.contains(b)) return false;
            if (i == 0) continue;
            if (pairs[i - 1].a > a || (pairs[i - 1].a == a && pairs[i - 1].b >= b)) return false;
        }
        return true;
    }
    void step() {
        cdprep_step step;
        const std::uint64_t before = hash();
        const bool is_of_caller = draw_.one_in(3), is_hostile = is_of_caller && draw_.one_in(2);
        if (is_of_caller) {
            const std::vector<cdprep_box_pair> pairs = candidates(is_hostile);
            const int code = cdprep_scene_step_with(scene_, pairs.data(), pairs.size(),
                                                    lanes_.get(), &step, &error_);
            MUST(is_answered(code, error_) == are_valid(pairs));
            MUST(code == CDPREP_OK || step.complete == CDPREP_NO);
        } else {
            const int code = cdprep_scene_step(scene_, lanes_.get(), &step, &error_);
            MUST(is_answered(code, error_));
        }
        if (step.complete == CDPREP_YES) note_events();
        // Hostile candidates may lack some.
        if (step.complete == CDPREP_YES && !is_hostile) compare();
        const cdprep_plan_options& most = *input_.get();
        MUST(step.needed_pairs == 0 || step.needed_pairs > most.max_pairs);
        MUST(step.needed_triangle_pairs == 0 ||
             step.needed_triangle_pairs > most.max_triangle_pairs);
        MUST(step.needed_contacts == 0 || step.needed_contacts > most.max_contacts);
        if (step.complete == CDPREP_NO) {
            MUST(hash() == before);
        } else {
            MUST(step.needed_pairs + step.needed_triangle_pairs + step.needed_contacts == 0);
        }
    }
    std::uint64_t hash() {
        std::uint64_t found = 0;
        MUST(is_answered(cdprep_scene_hash(scene_, &found, &error_), error_));
        return found;
    }

    // --- The oracle ----------------------------------------------------------------------

    struct Streams {
        std::span<const cdprep_scene_hit> hits;
        std::span<const cdprep_scene_overlap> overlaps;
        std::span<const cdprep_scene_distance> distances;
        std::span<const cdprep_scene_contact> contacts;
        std::span<const cdprep_scene_self_overlap> own;
        std::span<const cdprep_scene_impact> impacts;
        std::span<const cdprep_scene_bounded> bounded;
    };
    template <class T>
    std::span<const T> read(int (*function)(const cdprep_scene*, const T**, std::size_t*,
                                            cdprep_error*)) {
        const T* items = nullptr;
        std::size_t count = 99;
        MUST(is_answered(function(scene_, &items, &count, &error_), error_));
        return {items, count};
    }
    /// Takes over what holds after a step, and checks that the events lead there.
    void note_events() {
        Holding now;
        for (const cdprep_scene_hit& hit : read(cdprep_scene_hits)) {
            now[{hit.a.slot, hit.a.generation, hit.b.slot, hit.b.generation, hit.layer_pair}] =
                hit.holds;
        }
        std::size_t expected = 0;
        for (const auto& [key, held] : holding_) {
            expected += static_cast<std::size_t>(std::popcount(held & ~effects_of(now, key)));
        }
        for (const auto& [key, holds] : now) {
            const std::uint32_t held = effects_of(holding_, key);
            expected += static_cast<std::size_t>(std::popcount(holds & ~held));
            if (input_.pairs[key[4]].lists_stays != CDPREP_NO) {
                expected += static_cast<std::size_t>(std::popcount(holds & held));
            }
        }
        const std::span<const cdprep_event> events = read(cdprep_scene_events);
        MUST(events.size() == expected);
        for (const cdprep_event& event : events) {
            MUST(event.reason <= CDPREP_REASON_UNCHANGED);
            const bool is_of_one = event.effect == CDPREP_ASK_SELF;
            MUST(is_of_one ? event.a.slot == event.b.slot : event.a.slot < event.b.slot);
            const Key key = {event.a.slot, event.a.generation, event.b.slot, event.b.generation,
                             event.layer_pair};
            const bool held = (effects_of(holding_, key) & event.effect) != 0;
            const bool holds = (effects_of(now, key) & event.effect) != 0;
            MUST((held || holds) && std::popcount(event.effect) == 1);
            const std::uint32_t kind = held && holds ? CDPREP_EVENT_STAY
                                       : holds       ? CDPREP_EVENT_BEGIN
                                                     : CDPREP_EVENT_END;
            MUST(event.kind == kind);
        }
        holding_ = now;
    }
    void compare() {
        Streams streams = {read(cdprep_scene_hits),
                           read(cdprep_scene_overlaps),
                           read(cdprep_scene_distances),
                           read(cdprep_scene_contacts),
                           read(cdprep_scene_self_overlaps),
                           read(cdprep_scene_impacts),
                           read(cdprep_scene_bounded_distances)};
        for (auto a = objects_.begin(); a != objects_.end(); ++a) {
            compare_self(*a, streams);
            for (auto b = std::next(a); b != objects_.end(); ++b) compare_pair(*a, *b, streams);
        }
        MUST(streams.hits.empty() && streams.overlaps.empty() && streams.distances.empty() &&
             streams.contacts.empty());
        MUST(streams.own.empty() && streams.impacts.empty() && streams.bounded.empty());
    }

    /// Two objects and their pair of layers.
    using Key = std::array<std::uint32_t, 5>;
    using Holding = std::map<Key, std::uint32_t>;
    using Entry = std::pair<const std::uint32_t, Added>;

    static std::uint32_t effects_of(const Holding& holding, const Key& key) {
        const auto at = holding.find(key);
        return at == holding.end() ? 0 : at->second;
    }
    [[nodiscard]] const cdprep_layer_pair* pair_of(std::uint32_t a, std::uint32_t b,
                                                   std::uint32_t& number) const {
        for (number = 0; number < input_.get()->layer_pair_count; ++number) {
            const cdprep_layer_pair& pair = input_.pairs[number];
            if ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a)) {
                return pair.effects == 0 ? nullptr : &pair;
            }
        }
        return nullptr;
    }
    void compare_self(const Entry& object, Streams& streams) {
        std::uint32_t number = 0;
        const std::uint32_t layer = object.second.layer;
        const cdprep_layer_pair* const asks = pair_of(layer, layer, number);
        if (asks == nullptr || (asks->effects & ~paused_ & CDPREP_ASK_SELF) == 0) return;
        static std::vector<cdprep_overlap> room(kRoom);
        cdprep_overlap_list list = {room.data(), kRoom, 0};
        cdprep_self_query query;
        cdprep_self_query_init(&query, sizeof query);
        query.model = object.second.model;
        MUST(cdprep_self_overlaps(&query, lanes_.get(), &list, nullptr) == CDPREP_OK);
        if (list.count == 0) return;
        const cdprep_object id = {object.first, object.second.generation};
        MUST(!streams.own.empty() && std::memcmp(&streams.own[0].id, &id, sizeof id) == 0);
        const cdprep_scene_self_overlap& found = streams.own[0];
        MUST(found.count == list.count && found.layer_pair == number);
        for (std::size_t i = 0; i < list.count; ++i) {
            MUST(found.items[i].a == room[i].a && found.items[i].b == room[i].b);
        }
        streams.own = streams.own.subspan(1);
        const cdprep_scene_hit* const hit = take(streams.hits, id, id);
        MUST(hit != nullptr && hit->holds == CDPREP_ASK_SELF && hit->layer_pair == number);
    }
    void compare_pair(const Entry& a, const Entry& b, Streams& streams) {
        std::uint32_t number = 0;
        const cdprep_layer_pair* const asks = pair_of(a.second.layer, b.second.layer, number);
        if (asks == nullptr) return;
        const cdprep_object id_a = {a.first, a.second.generation};
        const cdprep_object id_b = {b.first, b.second.generation};
        cdprep_pair pair;
        cdprep_pair_init(&pair, sizeof pair);
        pair.a = a.second.model;
        pair.b = b.second.model;
        pair.moving = CDPREP_MOVE_BOTH;
        pair.pose_a = a.second.pose;
        pair.pose_b = b.second.pose;
        const std::uint32_t effects = asks->effects & ~paused_;
        std::uint32_t holds = 0;
        cdprep_collision collision{};
        if ((effects & CDPREP_ASK_COLLIDE) != 0) {
            cdprep_pair of = pair;
            of.body = asks->body;
            of.overlap = asks->overlap;
            MUST(cdprep_collide(&of, lanes_.get(), &collision, nullptr) == CDPREP_OK);
            if (collision.hit == CDPREP_YES) holds |= CDPREP_ASK_COLLIDE;
        }
        if ((effects & CDPREP_ASK_WITHIN) != 0) {
            std::uint32_t is_near = 9;
            MUST(cdprep_within(&pair, asks->tolerance, lanes_.get(), &is_near, nullptr) ==
                 CDPREP_OK);
            if (is_near == CDPREP_YES) holds |= CDPREP_ASK_WITHIN;
        }
        if ((effects & CDPREP_ASK_OVERLAP) != 0) {
            holds |= compare_overlaps(pair, *asks, take(streams.overlaps, id_a, id_b));
        }
        if ((effects & CDPREP_ASK_DISTANCE) != 0) {
            holds |= compare_distance(pair, *asks, take(streams.distances, id_a, id_b));
        }
        if ((effects & CDPREP_ASK_CONTACTS) != 0) {
            holds |= compare_contacts(pair, *asks, take(streams.contacts, id_a, id_b));
        }
        if ((effects & CDPREP_ASK_CONTINUOUS) != 0) {
            holds |= compare_impact(pair, take(streams.impacts, id_a, id_b));
        }
        if ((effects & CDPREP_ASK_HAPTIC) != 0) {
            holds |= compare_bounded(pair, *asks, take(streams.bounded, id_a, id_b));
        }
        const cdprep_scene_hit* const hit = take(streams.hits, id_a, id_b);
        MUST((hit != nullptr) == (holds != 0 || collision.hit == CDPREP_UNKNOWN));
        if (hit == nullptr) return;
        MUST(hit->holds == holds && hit->layer_pair == number);
        MUST(hit->collision.hit == collision.hit);
    }
    std::uint32_t compare_overlaps(cdprep_pair pair, const cdprep_layer_pair& asks,
                                   const cdprep_scene_overlap* found) {
        static std::vector<cdprep_overlap> room(kRoom);
        pair.overlap = asks.overlap;
        cdprep_overlap_list list = {room.data(), kRoom, 0};
        MUST(cdprep_overlaps(&pair, lanes_.get(), &list, nullptr) == CDPREP_OK);
        MUST(list.count <= kRoom && (found != nullptr) == (list.count > 0));
        if (found == nullptr) return 0;
        MUST(found->count == list.count);
        for (std::size_t i = 0; i < list.count; ++i) {
            MUST(found->items[i].a == room[i].a && found->items[i].b == room[i].b);
        }
        return CDPREP_ASK_OVERLAP;
    }
    std::uint32_t compare_distance(cdprep_pair pair, const cdprep_layer_pair& asks,
                                   const cdprep_scene_distance* found) {
        pair.body = asks.body;
        cdprep_distance_options options;
        cdprep_distance_options_init(&options, sizeof options);
        options.max_distance = asks.max_distance;
        cdprep_nearest nearest{};
        MUST(cdprep_distance(&pair, &options, lanes_.get(), &nearest, nullptr) == CDPREP_OK);
        MUST((found != nullptr) == (nearest.found == CDPREP_YES));
        if (found == nullptr) return 0;
        MUST(found->nearest.lower == nearest.lower && found->nearest.upper == nearest.upper);
        MUST(is_finite(found->nearest));
        return CDPREP_ASK_DISTANCE;
    }
    /// What touches at the end of its way has touched. The way itself is not known here.
    std::uint32_t compare_impact(const cdprep_pair& pair, const cdprep_scene_impact* found) {
        if (found == nullptr) {
            cdprep_collision collision{};
            MUST(cdprep_collide(&pair, lanes_.get(), &collision, nullptr) == CDPREP_OK);
            MUST(collision.hit == CDPREP_NO);
            return 0;
        }
        const cdprep_impact& impact = found->impact;
        MUST(impact.kind >= CDPREP_IMPACT_TOUCHING && impact.kind <= CDPREP_IMPACT_UNFINISHED);
        MUST(impact.lower >= 0 && impact.lower <= 1 && impact.upper >= impact.lower);
        if (impact.kind == CDPREP_IMPACT_TOUCHING) MUST(impact.upper <= 1);
        return CDPREP_ASK_CONTINUOUS;
    }
    std::uint32_t compare_bounded(const cdprep_pair& pair, const cdprep_layer_pair& asks,
                                  const cdprep_scene_bounded* found) {
        cdprep_distance_options options;
        cdprep_distance_options_init(&options, sizeof options);
        options.max_distance = asks.max_distance;
        cdprep_nearest nearest{};
        MUST(cdprep_distance(&pair, &options, lanes_.get(), &nearest, nullptr) == CDPREP_OK);
        if (found == nullptr) {
            MUST(nearest.found == CDPREP_NO);
            return 0;
        }
        MUST(found->bounded.lower <= asks.max_distance);
        if (nearest.found == CDPREP_YES) MUST(found->bounded.lower <= nearest.upper);
        if (found->bounded.complete == CDPREP_YES) {
            MUST(found->has_last == CDPREP_YES && found->late == 0);
            MUST(nearest.found == CDPREP_YES && found->bounded.nearest.lower == nearest.lower &&
                 found->bounded.nearest.upper == nearest.upper);
        } else {
            MUST(found->late > 0);
        }
        return CDPREP_ASK_HAPTIC;
    }
    std::uint32_t compare_contacts(cdprep_pair pair, const cdprep_layer_pair& asks,
                                   const cdprep_scene_contact* found) {
        static std::array<cdprep_contact, 256> room;
        pair.body = asks.body;
        cdprep_contact_options options;
        cdprep_contact_options_init(&options, sizeof options);
        options.most = 16;
        cdprep_contact_list list = {room.data(), room.size(), 0, 0, 0, 0, 0, 0};
        MUST(cdprep_contacts(&pair, asks.contacts != nullptr ? asks.contacts : &options,
                             lanes_.get(), &list, nullptr) == CDPREP_OK);
        MUST((found != nullptr) == (list.count > 0 || list.searched == CDPREP_NO));
        if (found == nullptr) return 0;
        MUST(found->count == list.count && found->found == list.found);
        MUST(found->complete == list.complete && found->searched == list.searched);
        MUST(found->computed == list.computed && found->work == list.work);
        for (std::size_t i = 0; i < list.count; ++i) {
            MUST(std::memcmp(&found->items[i], &room[i], sizeof room[i]) == 0);
        }
        return list.count > 0 ? CDPREP_ASK_CONTACTS : 0;
    }

    Draw& draw_;
    const Models& models_;
    Lanes lanes_;
    PlanInput input_;
    AlignedBytes memory_;
    cdprep_scene* scene_ = nullptr;
    std::array<std::uint32_t, kLayersUsed> asks_{};
    std::map<std::uint32_t, Added> objects_;  ///< by slot
    Holding holding_;                         ///< after the last step that was complete
    std::uint32_t paused_ = 0;
    cdprep_error error_{};
};

/// Plans that may be refused.
void compile_hostile_plan(Draw& draw, const Models& models) {
    const PlanInput input(draw, models, true);
    auto* plan = reinterpret_cast<cdprep_plan*>(1);
    cdprep_error error;
    int sentences = 0;
    const int code =
        cdprep_plan_compile(draw.one_in(40) ? nullptr : input.get(),
                            draw.one_in(2) ? count_sentence : nullptr, &sentences, &plan, &error);
    if (!is_answered(code, error)) {
        MUST(plan == nullptr);
        return;
    }
    MUST(sentences == 0);
    std::array<char, 50> text{};
    std::size_t length = 0, size = 0;
    MUST(cdprep_plan_text(plan, text.data(), draw.below(50), &length, nullptr) == CDPREP_OK);
    MUST(length > text.size() && text.back() == 0);
    MUST(cdprep_scene_size(plan, &size, nullptr) == CDPREP_OK && size > 0);
    std::uint32_t ask = 99;
    const std::uint32_t layer = draw.word();
    const bool is_layer = cdprep_plan_ask(plan, layer, &ask, nullptr) == CDPREP_OK;
    MUST(is_layer == (layer < CDPREP_LAYERS) && (is_layer || ask == 0));
    cdprep_plan_end(plan);
}

constexpr int kMostCalls = 48;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Models models(false);
    Draw draw({data, size});
    if (draw.one_in(4)) {
        for (int i = 0; i < kMostCalls && !draw.is_at_end(); ++i) {
            compile_hostile_plan(draw, models);
        }
        return 0;
    }
    World world(draw, models);
    for (int i = 0; i < kMostCalls && !draw.is_at_end(); ++i) world.call();
    return 0;
}
