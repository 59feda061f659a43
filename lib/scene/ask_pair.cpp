// SPDX-License-Identifier: MIT
#include "scene/ask_pair.h"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "cdprep/self.h"
#include "scene/object_box.h"
#include "scene/part_distance.h"

// Queries begin at the roots of both models, not with the potentially colliding set (GLOSSARY.md).
// Simulated walks over the same boxes were counted. The set takes 290 to 5,400 tests of boxes a
// pose. It spares 58 to 2,174 of 3,198 to 61,664 pairs of boxes. Slabs around its clusters spare
// 363 to 6,035, but take 13 intervals a cluster.
//
// Nor do hulls decide first. Of candidates that do not touch, they rule out 87 %. They take as long
// as the walks that they spare (scene_bench).
namespace cdprep {
namespace {

/// Runs a query and adds its time to those of its effect.
template <class Query>
void timed(const ListWriters& lists, Ask effect, const Query& query) noexcept {
    if (lists.clock == nullptr) return query();
    const std::uint64_t begin = lists.clock();
    query();
    lists.ticks[effect_number(effect)] += lists.clock() - begin;
}

/// The way of an object, or nothing if it is too long to compute.
std::optional<Motion> motion_of(const Model& model, const Pose& start, const Pose& end) noexcept {
    const Result<Motion> motion = Motion::between(start, end, middle_of(model));
    return motion ? std::optional(*motion) : std::nullopt;
}

}  // namespace

/// A query for each effect. They are not inlined: there are many kernels, and the functions called
/// here take far longer than a call.
class PairQueries {
public:
    PairQueries(const PairQuestion& question, Workspace& workspace, const ListWriters& lists,
                PairAnswer& answer) noexcept
        : question_(question),
          pair_(question.pair),
          asks_(question.asks),
          workspace_(workspace),
          lists_(lists),
          answer_(answer) {}

    // The later ones use what the earlier ones, kAsked, have found.
    [[gnu::noinline]] void overlap() noexcept {
        timed(lists_, Ask::overlap, [&] { find_overlaps(); });
    }
    [[gnu::noinline]] void distance() noexcept {
        timed(lists_, Ask::distance, [&] { find_distance(); });
    }
    template <Ask kAsked>
    [[gnu::noinline]] void collide() noexcept {
        timed(lists_, Ask::collide, [&] { decide_collide<kAsked>(); });
    }
    template <Ask kAsked>
    [[gnu::noinline]] void within() noexcept {
        timed(lists_, Ask::within, [&] { decide_within<kAsked>(); });
    }
    [[gnu::noinline]] void contacts() noexcept {
        timed(lists_, Ask::contacts, [&] { find_contacts(); });
    }
    [[gnu::noinline]] void continuous() noexcept {
        timed(lists_, Ask::continuous, [&] { find_impact(); });
    }
    [[gnu::noinline]] void haptic() noexcept {
        timed(lists_, Ask::haptic, [&] { find_haptic(); });
    }

private:
    /// Runs a query that begins at the near triangles. Then keeps those that it found, if any.
    template <class Query>
    [[nodiscard]] auto from_near(const Query& query) noexcept {
        PairCache cache;
        Pair pair = pair_;
        pair.cache = &cache;
        TreePair& near = answer_.starts.near;
        if (near.a != kNoPair.a) remember_pair(cache, near);
        const auto found = query(pair);
        near = has_pair(cache, pair.a, pair.b) ? TreePair{cache.triangle_a, cache.triangle_b}
                                               : kNoPair;
        return found;
    }

    void find_overlaps() noexcept {
        call(Ask::overlap);
        const auto add = [&](const TrianglePair& found) {
            lists_.triangle_pairs->add(found);
            ++answer_.overlapping;
            return true;
        };
        visit_overlaps(pair_, workspace_, add);
        hold(Ask::overlap, answer_.overlapping > 0);
    }

    void find_distance() noexcept {
        call(Ask::distance);
        const auto found = has_parts() ? distance_of_parts(pair_, *question_.parts_a,
                                                           *question_.parts_b, asks_.max_distance)
                                       : measured();
        if (found) answer_.distance = *found;
        hold(Ask::distance, found.has_value());
    }

    template <Ask kAsked>
    void decide_collide() noexcept {
        std::optional<Answer> known;
        if constexpr (contains(kAsked, Ask::overlap)) {
            known = answer_.overlapping > 0 ? Answer::yes : Answer::no;
        } else if constexpr (contains(kAsked, Ask::distance)) {
            known = touch_by_distance();
        }
        // Whether one solid is inside the other is a query of its own, unless parts have told.
        if (asks_.body == Body::solid && known != Answer::yes) {
            known = std::nullopt;
            if constexpr (contains(kAsked, Ask::distance)) {
                if (has_parts()) known = collide_by_parts();
            }
        }
        if (known) {
            answer_.collision.hit = *known;
        } else {
            call(Ask::collide);
            answer_.collision = collision();
        }
        hold(Ask::collide, answer_.collision.hit == Answer::yes);
    }

    template <Ask kAsked>
    void decide_within() noexcept {
        std::optional<bool> known;
        if constexpr (contains(kAsked, Ask::distance)) known = within_by_distance();
        if (!known) {
            call(Ask::within);
            const auto ask = [&](const Pair& pair) {
                return cdprep::within(pair, asks_.tolerance, workspace_);
            };
            // With a tolerance of 0, the query searches for a contact. A near pair does not help
            // it.
            known = asks_.tolerance > 0 ? from_near(ask) : ask(pair_);
        }
        hold(Ask::within, *known);
    }

    [[nodiscard]] std::optional<Distance> measured() noexcept {
        const DistanceOptions options = {.absolute_error = question_.max_error,
                                         .max_distance = asks_.max_distance};
        const auto ask = [&](const Pair& pair) {
            return cdprep::distance(pair, workspace_, options);
        };
        // Where an error is permitted, the answer would depend on where the search begins.
        return question_.max_error > 0 ? ask(pair_) : from_near(ask);
    }

    void find_contacts() noexcept {
        call(Ask::contacts);
        answer_.contacts = cdprep::contacts(pair_, workspace_, lists_.contact_room, asks_.contacts);
        for (std::size_t i = 0; i < answer_.contacts.count; ++i) {
            lists_.contacts->add(lists_.contact_room[i]);
        }
        hold(Ask::contacts, answer_.contacts.count > 0);
    }

    void find_impact() noexcept {
        call(Ask::continuous);
        const Model &a = pair_.a, &b = pair_.b;
        const auto motion_a = motion_of(a, question_.last_a, pair_.placement.pose_a());
        const auto motion_b = motion_of(b, question_.last_b, pair_.placement.pose_b());
        Impact& impact = answer_.impact;
        if (motion_a && motion_b) {
            impact =
                time_of_impact({a, b, *motion_a, *motion_b, asks_.body}, workspace_, asks_.impact);
        } else {
            impact.kind = ImpactKind::unfinished;  // nothing is proved
            impact.lower = 0;
        }
        hold(Ask::continuous, impact.kind != ImpactKind::none);
    }

    void find_haptic() noexcept {
        call(Ask::haptic);
        HapticRecord& record = *question_.haptic;
        Pair cached = pair_;
        cached.cache = &record.cache;
        record.found = bounded_distance(cached, workspace_, {.max_distance = asks_.max_distance},
                                        {.work = asks_.work, .last = &record.last});
        // A complete search that found nothing has proved that all is farther than max_distance.
        hold(Ask::haptic, record.found.is_complete ? record.found.nearest.has_value()
                                                   : record.found.lower <= asks_.max_distance);
    }

    void call(Ask effect) noexcept {
        answer_.called = answer_.called | effect;
    }
    [[nodiscard]] bool has_parts() const noexcept {
        return question_.parts_a != nullptr;
    }
    void hold(Ask effect, bool holds) noexcept {
        if (holds) answer_.holds = answer_.holds | effect;
    }

    /// As cdprep::collide(), but begins where the last contact was.
    [[nodiscard]] Collision collision() noexcept {
        if (any_contact_near(answer_.starts.touched, pair_, workspace_)) return {Answer::yes, {}};
        if (asks_.body == Body::surface) return {};
        const Containment inside = containment(pair_, workspace_);
        return {inside.answer, inside};
    }

    /// Whether the distance proves a gap.
    [[nodiscard]] bool is_apart() const noexcept {
        return !contains(answer_.holds, Ask::distance) || answer_.distance.lower > 0;
    }
    /// Whether the surfaces touch, if the distance tells.
    [[nodiscard]] std::optional<Answer> touch_by_distance() const noexcept {
        if (asks_.body == Body::solid || asks_.overlap != Overlap::closed) return std::nullopt;
        if (is_apart()) return Answer::no;
        return answer_.distance.upper == 0 ? std::optional(Answer::yes) : std::nullopt;
    }

    /// Whether the solids collide, if their parts tell. That parts touch says nothing about
    /// crossing.
    [[nodiscard]] std::optional<Answer> collide_by_parts() const noexcept {
        if (is_apart()) return Answer::no;
        return asks_.overlap == Overlap::closed ? std::optional(Answer::yes) : std::nullopt;
    }

    /// Whether the surfaces are near, if the distance tells. If an error is permitted, it always
    /// tells of surfaces that are measured.
    [[nodiscard]] std::optional<bool> within_by_distance() const noexcept {
        // The surfaces of solids are at least as far apart as the solids.
        if (!contains(answer_.holds, Ask::distance)) {
            return asks_.tolerance <= asks_.max_distance ? std::optional(false) : std::nullopt;
        }
        if (answer_.distance.lower > asks_.tolerance) return false;
        if (asks_.body == Body::solid) return std::nullopt;
        const bool is_near = question_.max_error > 0 || answer_.distance.upper <= asks_.tolerance;
        return is_near ? std::optional(true) : std::nullopt;
    }

    const PairQuestion& question_;
    const Pair& pair_;
    const LayerPair& asks_;
    Workspace& workspace_;
    const ListWriters& lists_;
    PairAnswer& answer_;
};

namespace {

/// The effects of two objects, in the order of the bits of a kernel's number.
constexpr std::array kPairEffects = {Ask::collide,  Ask::overlap,    Ask::within, Ask::distance,
                                     Ask::contacts, Ask::continuous, Ask::haptic};
constexpr std::size_t kKernels = std::size_t{1} << kPairEffects.size();

constexpr Ask effects_of_kernel(std::size_t number) noexcept {
    Ask effects = Ask::nothing;
    for (std::size_t i = 0; i < kPairEffects.size(); ++i) {
        if ((number >> i & 1) != 0) effects = effects | kPairEffects[i];
    }
    return effects;
}

template <Ask kEffects>
void ask_effects(PairQueries& queries) noexcept {
    if constexpr (contains(kEffects, Ask::overlap)) queries.overlap();
    if constexpr (contains(kEffects, Ask::distance)) queries.distance();
    if constexpr (contains(kEffects, Ask::collide)) {
        queries.template collide<kEffects&(Ask::overlap | Ask::distance)>();
    }
    if constexpr (contains(kEffects, Ask::within)) {
        queries.template within<kEffects & Ask::distance>();
    }
    if constexpr (contains(kEffects, Ask::contacts)) queries.contacts();
    if constexpr (contains(kEffects, Ask::continuous)) queries.continuous();
    if constexpr (contains(kEffects, Ask::haptic)) queries.haptic();
}

template <std::size_t kNumber>
constexpr PairKernel kernel_of() noexcept {
    constexpr Ask kEffects = effects_of_kernel(kNumber);
    if constexpr (are_built_together(kEffects)) return &ask_effects<kEffects>;
    return nullptr;
}

template <std::size_t... kNumbers>
constexpr std::array<PairKernel, kKernels> all_kernels(
    std::index_sequence<kNumbers...> /*numbers*/) noexcept {
    return {kernel_of<kNumbers>()...};
}

constexpr std::array<PairKernel, kKernels> kPairKernels =
    all_kernels(std::make_index_sequence<kKernels>());

}  // namespace

PairKernel pair_kernel(Ask effects) noexcept {
    std::size_t number = 0;
    for (std::size_t i = 0; i < kPairEffects.size(); ++i) {
        if (contains(effects, kPairEffects[i])) number |= std::size_t{1} << i;
    }
    return effects_of_kernel(number) == effects ? kPairKernels[number] : nullptr;
}

PairAnswer ask_pair(const PairQuestion& question, PairKernel kernel, Workspace& workspace,
                    const ListWriters& lists) noexcept {
    PairAnswer answer;
    answer.starts = question.starts;
    PairQueries queries(question, workspace, lists, answer);
    kernel(queries);
    return answer;
}

PairAnswer ask_self(const Model& model, Workspace& workspace, const ListWriters& lists) noexcept {
    PairAnswer answer;
    answer.called = Ask::self;
    timed(lists, Ask::self, [&] {
        const auto add = [&](const TrianglePair& found) {
            lists.triangle_pairs->add(found);
            ++answer.overlapping;
            return true;
        };
        visit_self_overlaps(model, workspace, add);
    });
    if (answer.overlapping > 0) answer.holds = Ask::self;
    return answer;
}

}  // namespace cdprep
