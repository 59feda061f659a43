// SPDX-License-Identifier: MIT
#include "scene/ask_pair.h"

#include <array>
#include <optional>

#include "cdprep/self.h"
#include "scene/object_box.h"

// Queries begin at the roots of both models, not with the potentially colliding set (GLOSSARY.md).
// Simulated walks over the same boxes were counted. The set takes 290 to 5,400 tests of boxes a
// pose. It spares 58 to 2,174 of 3,198 to 61,664 pairs of boxes. Slabs around its clusters spare
// 363 to 6,035, but take 13 intervals a cluster.
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

class PairQueries {
public:
    PairQueries(const PairQuestion& question, Workspace& workspace, PairAnswer& answer) noexcept
        : question_(question),
          pair_(question.pair),
          asks_(question.asks),
          workspace_(workspace),
          answer_(answer) {}

    // The later ones use what the earlier ones have found.
    void overlap(ListPages<TrianglePair>::Writer& list) noexcept {
        call(Ask::overlap);
        const auto add = [&](const TrianglePair& found) {
            list.add(found);
            ++answer_.overlapping;
            return true;
        };
        visit_overlaps(pair_, workspace_, add);
        hold(Ask::overlap, answer_.overlapping > 0);
    }

    void distance() noexcept {
        call(Ask::distance);
        const auto found =
            cdprep::distance(pair_, workspace_, {.max_distance = asks_.max_distance});
        if (found) answer_.distance = *found;
        hold(Ask::distance, found.has_value());
    }

    void collide() noexcept {
        std::optional<Answer> known;
        if (called(Ask::overlap))
            known = answer_.overlapping > 0 ? Answer::yes : Answer::no;
        else if (asks_.overlap == Overlap::closed)
            known = touches_by_distance();
        // Whether one solid is inside the other is a query of its own.
        const bool is_decided = asks_.body == Body::surface || known == Answer::yes;
        if (known && is_decided) {
            answer_.collision.hit = *known;
        } else {
            call(Ask::collide);
            answer_.collision = collision();
        }
        hold(Ask::collide, answer_.collision.hit == Answer::yes);
    }

    void within() noexcept {
        std::optional<bool> known = within_by_distance();
        if (!known) {
            call(Ask::within);
            known = cdprep::within(pair_, asks_.tolerance, workspace_);
        }
        hold(Ask::within, *known);
    }

    void contacts(const ListWriters& lists) noexcept {
        call(Ask::contacts);
        answer_.contacts = cdprep::contacts(pair_, workspace_, lists.contact_room, asks_.contacts);
        for (std::size_t i = 0; i < answer_.contacts.count; ++i) {
            lists.contacts->add(lists.contact_room[i]);
        }
        hold(Ask::contacts, answer_.contacts.count > 0);
    }

    void continuous() noexcept {
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

    void haptic() noexcept {
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

private:
    void call(Ask effect) noexcept {
        answer_.called = answer_.called | effect;
    }
    [[nodiscard]] bool called(Ask effect) const noexcept {
        return contains(answer_.called, effect);
    }
    void hold(Ask effect, bool holds) noexcept {
        if (holds) answer_.holds = answer_.holds | effect;
    }

    /// As cdprep::collide(), but begins where the last contact was.
    [[nodiscard]] Collision collision() noexcept {
        if (any_contact_near(answer_.touched, pair_, workspace_)) return {Answer::yes, {}};
        if (asks_.body == Body::surface) return {};
        const Containment inside = containment(pair_, workspace_);
        return {inside.answer, inside};
    }

    /// Whether the surfaces touch, if the distance tells.
    [[nodiscard]] std::optional<Answer> touches_by_distance() const noexcept {
        if (!called(Ask::distance) || asks_.body == Body::solid) return std::nullopt;
        if (!contains(answer_.holds, Ask::distance) || answer_.distance.lower > 0) {
            return Answer::no;
        }
        return answer_.distance.upper == 0 ? std::optional(Answer::yes) : std::nullopt;
    }

    /// Whether the surfaces are near, if the distance tells.
    [[nodiscard]] std::optional<bool> within_by_distance() const noexcept {
        if (!called(Ask::distance)) return std::nullopt;
        // The surfaces of solids are at least as far apart as the solids.
        if (!contains(answer_.holds, Ask::distance)) {
            return asks_.tolerance <= asks_.max_distance ? std::optional(false) : std::nullopt;
        }
        if (answer_.distance.lower > asks_.tolerance) return false;
        const bool is_near =
            asks_.body == Body::surface && answer_.distance.upper <= asks_.tolerance;
        return is_near ? std::optional(true) : std::nullopt;
    }

    const PairQuestion& question_;
    const Pair& pair_;
    const LayerPair& asks_;
    Workspace& workspace_;
    PairAnswer& answer_;
};

}  // namespace

PairAnswer ask_pair(const PairQuestion& question, Workspace& workspace,
                    const ListWriters& lists) noexcept {
    const Ask effects = question.effects;
    PairAnswer answer;
    answer.touched = question.touched;
    PairQueries queries(question, workspace, answer);
    const auto ask = [&](Ask effect, const auto& query) {
        if (contains(effects, effect)) timed(lists, effect, query);
    };
    ask(Ask::overlap, [&] { queries.overlap(*lists.triangle_pairs); });
    ask(Ask::distance, [&] { queries.distance(); });
    ask(Ask::collide, [&] { queries.collide(); });
    ask(Ask::within, [&] { queries.within(); });
    ask(Ask::contacts, [&] { queries.contacts(lists); });
    ask(Ask::continuous, [&] { queries.continuous(); });
    ask(Ask::haptic, [&] { queries.haptic(); });
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
