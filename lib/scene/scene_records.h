// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/pair_cache.h"
#include "cdprep/bounded_distance.h"
#include "cdprep/broad_phase.h"
#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "cdprep/scene.h"
#include "core/carver.h"
#include "walk/find_contact.h"

namespace cdprep {

/// The effects of a pair of layers that two objects are asked for.
inline Ask effects_between(const LayerPair& pair) noexcept {
    return without(pair.effects, Ask::self | kSceneChanges);
}

/// Whether Plan accepts these effects of two objects for a pair of layers.
constexpr bool are_built_together(Ask effects) noexcept {
    return !contains(effects, Ask::haptic | Ask::distance);
}

/// The place of an effect among kSceneEffects.
inline std::size_t effect_number(Ask effect) noexcept {
    const auto* const at = std::find(kSceneEffects.begin(), kSceneEffects.end(), effect);
    return static_cast<std::size_t>(at - kSceneEffects.begin());
}

/// Triangles with which searches begin, or kNoPair. They change times, never answers.
struct SearchStarts {
    TreePair touched = kNoPair;  ///< of `collide`: they touched
    TreePair near = kNoPair;     ///< of `within` and `distance`: they were the nearest, or near
};

/// What `haptic` knows of two objects.
struct HapticRecord {
    BoundedDistance found;
    LastDistance last;
    PairCache cache;
};

/// The items of one record among those of all records.
struct RecordList {
    std::size_t source = 0;   ///< of the first, where the step has it from
    std::uint32_t place = 0;  ///< of the first
    std::uint32_t count = 0;
};

/// What is known of two objects whose boxes meet, or of one object that is asked about itself.
struct Record {
    ObjectId a;
    ObjectId b;
    std::uint32_t pair = 0;
    Ask asked = Ask::nothing;   ///< effects that are known
    Ask called = Ask::nothing;  ///< effects whose query was called in this step
    Ask holds = Ask::nothing;
    SearchStarts starts;    ///< of the next search
    bool is_new = false;    ///< looked at in this step
    bool is_apart = false;  ///< by the root boxes: nothing is asked

    [[nodiscard]] bool is_of_one() const noexcept {
        return a.slot == b.slot;
    }
    [[nodiscard]] BoxPair slots() const noexcept {
        return {a.slot, b.slot};
    }
    [[nodiscard]] bool is_same(const Record& other) const noexcept {
        return a == other.a && b == other.b && pair == other.pair;
    }
};

/// Whether `collide` is asked of solids: then more is known than whether it holds.
inline bool collides_solids(const Plan& plan) noexcept {
    return std::any_of(plan.pairs().begin(), plan.pairs().end(), [](const LayerPair& pair) {
        return contains(pair.effects, Ask::collide) && pair.body == Body::solid;
    });
}

/// The records of a step, sorted by slots. Arrays that the plan does not need are null.
struct Records {
    Records(Carver& carver, const Plan& plan) noexcept
        : record(carver.take<Record>(plan.limits().pairs)) {
        const SceneLimits& limits = plan.limits();
        const Ask effects = plan.effects();
        if (contains(effects, Ask::distance)) distance = carver.take<Distance>(limits.pairs);
        if (contains(effects, Ask::continuous)) impact = carver.take<Impact>(limits.pairs);
        if (contains(effects, Ask::haptic)) haptic = carver.take<HapticRecord>(limits.pairs);
        if (collides_solids(plan)) collision = carver.take<Collision>(limits.pairs);
        if ((effects & (Ask::overlap | Ask::self)) != Ask::nothing) {
            triangle_list = carver.take<RecordList>(limits.pairs);
            triangle_pairs = carver.take<TrianglePair>(limits.triangle_pairs);
        }
        if (contains(effects, Ask::contacts)) {
            contact_list = carver.take<RecordList>(limits.pairs);
            verdict = carver.take<ContactsVerdict>(limits.pairs);
            contacts = carver.take<Contact>(limits.contacts);
        }
    }

    /// What `collide` found.
    [[nodiscard]] Collision collision_of(std::uint32_t number) const noexcept {
        if (collision != nullptr) return collision[number];
        return {contains(record[number].holds, Ask::collide) ? Answer::yes : Answer::no, {}};
    }

    std::uint32_t count = 0;
    Record* record;  ///< by number, as are the next seven
    Collision* collision = nullptr;
    Distance* distance = nullptr;
    Impact* impact = nullptr;
    HapticRecord* haptic = nullptr;
    ContactsVerdict* verdict = nullptr;
    RecordList* triangle_list = nullptr;
    RecordList* contact_list = nullptr;
    TrianglePair* triangle_pairs = nullptr;
    Contact* contacts = nullptr;
};

/// Calls `visit(i, j)` for each pair of slots. i and j are the indices of its records in x and in
/// y. Where it has no record, the index is the count.
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

}  // namespace cdprep
