// SPDX-License-Identifier: MIT
#include "scene/ask_pair.h"

#include <optional>

namespace cdprep {
namespace {

class PairQueries {
public:
    PairQueries(const PairQuestion& question, Workspace& workspace, PairAnswer& answer) noexcept
        : pair_(question.pair), asks_(question.asks), workspace_(workspace), answer_(answer) {}

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
    if (contains(effects, Ask::overlap)) queries.overlap(*lists.triangle_pairs);
    if (contains(effects, Ask::distance)) queries.distance();
    if (contains(effects, Ask::collide)) queries.collide();
    if (contains(effects, Ask::within)) queries.within();
    if (contains(effects, Ask::contacts)) queries.contacts(lists);
    return answer;
}

}  // namespace cdprep
