// SPDX-License-Identifier: MIT
#include "cdprep/contacts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <optional>
#include <tuple>

#include "cdprep/format/float_environment.h"
#include "core/numbers.h"
#include "core/require.h"
#include "pieces/cluster_contacts.h"
#include "pieces/contact_choice.h"
#include "pieces/contact_steps.h"
#include "pieces/deep_contact.h"
#include "pieces/list_contacts.h"
#include "pieces/piece_parts.h"
#include "walk/contact_pairs.h"
#include "walk/near_triangles.h"

// Pairs of triangles within the tolerance show which pieces are within it. A pair of pieces occurs
// once for each such pair of triangles. A walk keeps the smallest pairs of pieces, each once, as
// many as there is room for. With each it keeps the first pair of triangles, a touching one if
// there is any. If there are more pairs of pieces, another walk takes the next ones. So the answers
// come in order, and memory does not grow with their number.

namespace cdprep {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// The smallest pairs of pieces above those that were answered before.
class Gathered {
public:
    explicit Gathered(std::span<NearPieces> room) noexcept : room_(room) {}

    /// Forgets all, and from now on takes only keys after `last`.
    void begin_after(const std::optional<std::uint64_t>& last) noexcept {
        count_ = 0;
        recent_.fill(kNone);
        limit_ = kNoLimit;
        least_ = last ? *last + 1 : 0;
    }
    [[nodiscard]] bool takes(std::uint64_t key) const noexcept {
        return key >= least_ && key <= limit_;
    }
    /// Adds two triangles; touch() tells whether they touch, and may be costly.
    template <class Touch>
    void add(std::uint64_t key, std::uint32_t a, std::uint32_t b, Touch&& touch) noexcept {
        std::uint16_t& recent = recent_[(key * kMixer) >> (64 - kRecentBits)];
        if (recent != kNone && room_[recent].key == key) {
            NearPieces& known = room_[recent];
            const bool is_first = a != known.a ? a < known.a : b < known.b;
            if (known.touch && !is_first) return;
            const NearPieces near = {key, a, b, touch()};
            if (near.touch != known.touch ? near.touch : is_first) known = near;
            return;
        }
        recent = static_cast<std::uint16_t>(count_);
        room_[count_++] = {key, a, b, touch()};
        if (count_ == room_.size()) reduce(room_.size() / 2);
    }
    /// Returns all that were taken, in order, each once.
    [[nodiscard]] std::span<const NearPieces> all() noexcept {
        reduce(room_.size());
        return room_.first(count_);
    }
    /// Returns whether greater keys were left out.
    [[nodiscard]] bool is_limited() const noexcept {
        return limit_ != kNoLimit;
    }

private:
    void reduce(std::size_t most) noexcept {
        const auto begin = room_.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(count_);
        std::sort(begin, end, [](const NearPieces& x, const NearPieces& y) {
            if (x.key != y.key) return x.key < y.key;
            if (x.touch != y.touch) return x.touch;
            return x.a != y.a ? x.a < y.a : x.b < y.b;
        });
        const auto last = std::unique(
            begin, end, [](const NearPieces& x, const NearPieces& y) { return x.key == y.key; });
        count_ = static_cast<std::size_t>(last - begin);
        recent_.fill(kNone);
        if (count_ <= most) return;
        count_ = most;
        limit_ = room_[count_ - 1].key;
    }

    static constexpr unsigned kRecentBits = 9;  ///< log2 of the places: 1 KiB, filled for each page
    static constexpr std::uint64_t kMixer = 0x9e3779b97f4a7c15U;  ///< 2^64 / the golden ratio
    static constexpr std::uint16_t kNone = 0xffff;
    static_assert(kMaxNearPieces < kNone);

    std::span<NearPieces> room_;
    std::size_t count_ = 0;
    /// Places in room_ by a hash of the key: most pairs of triangles are of pieces that are there.
    std::array<std::uint16_t, std::size_t{1} << kRecentBits> recent_;
    std::uint64_t limit_ = kNoLimit;  ///< greater ones are not taken
    std::uint64_t least_ = 0;
};

class ContactSearch {
public:
    ContactSearch(const Pair& pair, Workspace& workspace, const ContactOptions& options) noexcept
        : pair_(pair),
          moved_a_(moved_a(pair.a, pair.placement)),
          moved_b_(moved_b(pair.b, pair.placement)),
          options_(options),
          workspace_(workspace),
          gathered_(workspace.storage().near_pieces) {}

    /// Calls found(contact) for each contact in order until it returns false or the work is done.
    /// Returns false if either ended the search.
    template <class Found>
    bool run(Found&& found) noexcept {
        Contacts contacts(*this, options_.manifold);
        return each_page([&](const NearPieces& near) {
                   return begin_contact(work_of(near)) && found(contacts.of(near));
               }) &&
               each_deep(found);
    }
    /// Counts the pairs of pieces within the tolerance, and the enclosed components.
    void count() noexcept {
        each_page([](const NearPieces&) { return true; });
        each_enclosed([](const Enclosed&) { return true; });
    }

    /// Finds the contacts of a list with a limit, with their manifolds. Valid until the next query.
    [[nodiscard]] std::span<Contact> list() noexcept {
        using Known = ContactCandidate::Known;
        Workspace::Storage& storage = workspace_.storage();
        ContactChoice choice(storage.contact_candidates);
        Contacts contacts(*this, options_.manifold);
        const std::size_t most = std::min(options_.most, kMostListedContacts);
        std::uint64_t work_of_all = 0;
        each_page([&](const NearPieces& near) {
            work_of_all += work_of(near) + kWorkOfBound;
            // Where all are listed and no limit may end the choice, no bound is needed. Of solids,
            // enclosed components may take places of the list.
            const bool takes_all = options_.work == 0 && pair_.options.body == Body::surface &&
                                   !gathered_.is_limited() && verdict_.found <= most;
            const double depth = takes_all ? kInfinity : contacts.most_depth(near);
            const Double3 at = moved_a_.corners(near.a)[0];
            choice.add({depth, Known::roughly, kNoSlot, at, near, 0});
            return true;
        });
        std::uint32_t slots = 0;
        const auto compute = [&](ContactCandidate& candidate) {
            if (!begin_contact(work_of(candidate.near))) return false;
            const Contact contact = contacts.of(candidate.near);
            candidate.depth = -contact.upper;
            if (slots < kMaxComputedContacts) {
                storage.computed_contacts[slots] = contact;
                candidate.slot = slots++;
            }
            candidate.known = Known::exactly;
            return true;
        };
        const std::size_t deep = list_deep(std::span(storage.listed_contacts).first(most));
        // Bounds save time where many contacts would be computed. They would use up a limit that
        // allows few.
        const bool allows_all = options_.work == 0 || options_.work > verdict_.work + work_of_all;
        const auto bound = [&](ContactCandidate& candidate) {
            if (!allows_all) return compute(candidate);
            verdict_.work += kWorkOfBound;
            candidate.depth =
                std::min(candidate.depth, contacts.most_depth_by_faces(candidate.near));
            candidate.known = Known::by_faces;
            return true;
        };
        std::size_t count = deep;
        for (const ContactCandidate& chosen : choice.choose(most - deep, bound, compute)) {
            storage.listed_contacts[count++] = chosen.slot == kNoSlot
                                                   ? contacts.of(chosen.near)
                                                   : storage.computed_contacts[chosen.slot];
        }
        verdict_.complete = verdict_.searched && count == verdict_.found;
        const auto listed = std::span(storage.listed_contacts).first(count);
        if (deep > 0) std::sort(listed.begin(), listed.end(), is_deeper);
        if (!(options_.cluster_angle > 0)) return listed;
        return listed.first(cluster_contacts(listed, options_.cluster_angle));
    }

    [[nodiscard]] ContactsVerdict& verdict() noexcept {
        return verdict_;
    }

private:
    static bool is_deeper(const Contact& x, const Contact& y) noexcept {
        return std::tie(x.upper, x.piece_a, x.piece_b) < std::tie(y.upper, y.piece_a, y.piece_b);
    }

    /// Calls visit(enclosed) for each component of one solid that is inside the other.
    template <class Visit>
    bool each_enclosed(Visit&& visit) noexcept {
        if (pair_.options.body != Body::solid) return true;
        return visit_enclosed(pair_, workspace_, [&](const Enclosed& enclosed) {
            ++verdict_.found;
            return visit(enclosed);
        });
    }
    /// Calls found(contact) for each of them until it returns false or the work is done.
    template <class Found>
    bool each_deep(Found&& found) noexcept {
        return each_enclosed([&](const Enclosed& enclosed) {
            return begin_contact(kWorkOfContact) &&
                   found(deep_contact(pair_, enclosed, options_.manifold, workspace_.storage()));
        });
    }
    /// Stores the deepest contacts of enclosed components. Returns their number.
    [[nodiscard]] std::size_t list_deep(std::span<Contact> room) noexcept {
        std::size_t count = 0;
        each_deep([&](const Contact& contact) {
            if (count < room.size()) {
                room[count++] = contact;
            } else if (const auto last = std::max_element(room.begin(), room.end(), is_deeper);
                       is_deeper(contact, *last)) {
                *last = contact;
            }
            return true;
        });
        return count;
    }

    /// Calls visit(near) for each pair of pieces in order until it returns false. Returns false if
    /// it did, or if the search ran out of work.
    template <class Visit>
    bool each_page(Visit&& visit) noexcept {
        std::optional<std::uint64_t> last;
        do {
            gather(last);
            const std::span<const NearPieces> all = gathered_.all();
            verdict_.found += all.size();
            for (const NearPieces& near : all) {
                if (!visit(near)) return false;
                last = near.key;
            }
        } while (gathered_.is_limited() && verdict_.searched);
        return verdict_.searched;
    }
    /// Returns the work of a contact of two pieces. It grows with their triangles, but slowly: few
    /// of those of a large piece are visited.
    [[nodiscard]] std::uint64_t work_of(const NearPieces& near) const noexcept {
        const auto triangles = [](const Model& model, std::uint32_t piece) {
            return part_of_piece(model.pieces().triangles, model, piece,
                                 &format::Piece::first_triangle)
                .size();
        };
        const std::size_t both = triangles(pair_.a, static_cast<std::uint32_t>(near.key >> 32)) +
                                 triangles(pair_.b, static_cast<std::uint32_t>(near.key));
        return kWorkOfContact + both / kTrianglesOfWork;
    }
    /// Counts a contact. Returns false if there is no work left for it.
    [[nodiscard]] bool begin_contact(std::uint64_t work) noexcept {
        if (is_out_of_work(options_.work)) return false;
        verdict_.work += work;
        ++verdict_.computed;
        return true;
    }

    /// The contacts of pairs of pieces. The piece of A stays moved for as long as it is the same.
    class Contacts {
    public:
        Contacts(const ContactSearch& search, Manifold manifold) noexcept
            : search_(search),
              question_{&search.pair_.placement, search.options_, search.pair_.options.degenerate,
                        search.workspace_.storage().counts} {
            question_.options.manifold = manifold;
            for (PlacedHull& hull : placed()) hull.piece = PlacedHull::kNoPiece;
        }

        [[nodiscard]] Contact of(const NearPieces& near) noexcept {
            ContactSide b(search_.moved_b_, static_cast<std::uint32_t>(near.key), &placed()[1],
                          search_.workspace_.storage());
            question_.searched = search_.verdict_.searched;
            return contact_of_pieces(a_of(near), b, near, question_);
        }
        /// Returns a bound of how deep the contact is; negative if it is that far apart.
        [[nodiscard]] double most_depth(const NearPieces& near) noexcept {
            const ContactSide b(search_.moved_b_, static_cast<std::uint32_t>(near.key),
                                &placed()[1], search_.workspace_.storage());
            return most_depth_of_pieces(a_of(near), b, near);
        }
        /// Returns a closer bound.
        [[nodiscard]] double most_depth_by_faces(const NearPieces& near) noexcept {
            ContactSide b(search_.moved_b_, static_cast<std::uint32_t>(near.key), &placed()[1],
                          search_.workspace_.storage());
            return cdprep::most_depth_by_faces(a_of(near), b, near);
        }

    private:
        [[nodiscard]] std::array<PlacedHull, 2>& placed() const noexcept {
            return search_.workspace_.storage().placed_hulls;
        }
        [[nodiscard]] ContactSide& a_of(const NearPieces& near) noexcept {
            const auto piece_a = static_cast<std::uint32_t>(near.key >> 32);
            if (!a_ || piece_a_ != piece_a) {
                a_.emplace(search_.moved_a_, piece_a, &placed()[0], search_.workspace_.storage());
            }
            piece_a_ = piece_a;
            return *a_;
        }

        std::optional<ContactSide> a_;
        const ContactSearch& search_;
        ContactQuestion question_;
        std::uint32_t piece_a_ = 0;
    };

    [[nodiscard]] bool is_out_of_work(std::uint64_t limit) const noexcept {
        return options_.work != 0 && verdict_.work >= limit;
    }

    void gather(const std::optional<std::uint64_t>& last) noexcept {
        gathered_.begin_after(last);
        const std::span<const std::uint32_t> piece_a = moved_a_.model->pieces().of_triangle;
        const std::span<const std::uint32_t> piece_b = moved_b_.model->pieces().of_triangle;
        const auto visit = [&](const NearTriangles& near) {
            if (is_out_of_work(options_.work - options_.work / 2)) return false;
            ++verdict_.work;
            const std::uint64_t key = std::uint64_t{piece_a[near.a]} << 32 | piece_b[near.b];
            if (gathered_.takes(key)) {
                gathered_.add(key, near.a, near.b, [&] { return touch(near); });
            }
            return true;
        };
        verdict_.searched =
            visit_near_triangles(pair_.options.through, pair_.a, pair_.b, pair_.placement,
                                 options_.tolerance, workspace_, visit, pair_.options);
    }
    [[nodiscard]] bool touch(const NearTriangles& near) const noexcept {
        if (near.touch != Touch::unknown) return near.touch == Touch::yes;
        return in_contact(moved_a_.corners(near.a), moved_b_.corners(near.b), Overlap::closed,
                          workspace_.storage().counts);
    }

    const Pair& pair_;
    MovedModel moved_a_;
    MovedModel moved_b_;
    ContactOptions options_;
    Workspace& workspace_;
    Gathered gathered_;
    ContactsVerdict verdict_{0, 0, 0, 0, true, false};
};

Ask asks_of(const Pair& pair) noexcept {
    const Ask body = pair.options.body == Body::solid ? Ask::solid : Ask::nothing;
    return Ask::contacts | body | ask_of(pair.options.through);
}

}  // namespace

ListedContacts list_contacts(const Pair& pair, Workspace& workspace,
                             const ContactOptions& options) noexcept {
    assert(options.most > 0);
    ContactSearch search(pair, workspace, options);
    const std::span<const Contact> listed = search.list();
    return {listed, search.verdict()};
}

ContactsVerdict contacts(const Pair& pair, Workspace& workspace, std::span<Contact> room,
                         const ContactOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(pair.a, pair.b, asks_of(pair));
    if (options.most > 0) {
        auto [listed, verdict] = list_contacts(pair, workspace, options);
        verdict.count = std::min(listed.size(), room.size());
        std::copy_n(listed.begin(), verdict.count, room.begin());
        verdict.complete = verdict.complete && verdict.count == listed.size();
        return verdict;
    }
    ContactSearch search(pair, workspace, options);
    ContactsVerdict& verdict = search.verdict();
    if (room.empty()) {
        search.count();
        verdict.complete = verdict.found == 0 && verdict.searched;
        return verdict;
    }
    const bool all = search.run([&](const Contact& contact) {
        if (verdict.count < room.size()) room[verdict.count++] = contact;
        return true;
    });
    verdict.complete = all && verdict.count == verdict.found;
    return verdict;
}

bool visit_contacts(const Pair& pair, Workspace& workspace, ContactVisitor visit,
                    const ContactOptions& options) noexcept {
    format::FloatEnvironment environment;
    require(pair.a, pair.b, asks_of(pair));
    ContactSearch search(pair, workspace, options);
    return search.run([&](const Contact& contact) {
        return environment.outside([&] { return visit(contact); });
    });
}

}  // namespace cdprep
