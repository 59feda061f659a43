// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "exact/vectors.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Chooses the contacts of a list with a limit: the deepest, and others spread over the surface.
///
/// Most candidates are only known to be no deeper than a bound. Those that may be the deepest are
/// examined, the one with the largest bound first. They get a closer bound. If they may still be
/// the deepest, they are computed.
class ContactChoice {
public:
    explicit ContactChoice(std::span<ContactCandidate> room) noexcept : room_(room) {}

    /// Adds a candidate. If there is no room, the one with the smallest bound goes.
    void add(const ContactCandidate& candidate) noexcept;

    /// Returns at most `most` candidates. If there are more, every second one is the deepest that
    /// is left, and the others are those farthest from all that were taken. `bound(candidate)`
    /// gives a candidate a closer bound, `compute(candidate)` its depth. Either may return false to
    /// end the choice: then those that are exact are returned. Nothing can be added afterwards.
    template <class Bound, class Compute>
    [[nodiscard]] std::span<ContactCandidate> choose(std::size_t most, Bound&& bound,
                                                     Compute&& compute) noexcept;

private:
    using Known = ContactCandidate::Known;

    /// Closer bounds save time if there are more than this many candidates for each that is listed.
    static constexpr std::size_t kManyMore = 2;

    /// By depth, then by pieces: a strict order, which does not depend on the search. Of two with
    /// equal depths, the one that is less known comes first, to be computed.
    static bool is_deeper(const ContactCandidate& x, const ContactCandidate& y) noexcept {
        if (x.depth != y.depth) return x.depth > y.depth;
        if (x.known != y.known) return x.known < y.known;
        return x.near.key < y.near.key;
    }
    /// Returns the first `taken` candidates, and the deepest of the others that are exact.
    [[nodiscard]] std::span<ContactCandidate> take_exact(std::size_t taken,
                                                         std::size_t most) noexcept;
    /// Brings the first candidate by is_deeper() of those from `first` there. If it is exact, none
    /// of the others is deeper.
    void bring_deepest(std::size_t first) noexcept {
        const auto rest = room_.first(count_).subspan(first);
        std::iter_swap(rest.begin(), std::min_element(rest.begin(), rest.end(), is_deeper));
    }
    /// Brings the candidate farthest from those before `first` there.
    void bring_farthest(std::size_t first) noexcept;
    /// Forgets all gaps, and finds a scale at which their squares stay in the range of double.
    void begin_gaps() noexcept;
    void update_gaps(std::size_t taken) noexcept;

    std::span<ContactCandidate> room_;
    std::size_t count_ = 0;
    double scale_ = 1;  ///< a power of two
};

template <class Bound, class Compute>
std::span<ContactCandidate> ContactChoice::choose(std::size_t most, Bound&& bound,
                                                  Compute&& compute) noexcept {
    const auto all = room_.first(count_);
    begin_gaps();
    const bool has_rest = count_ > most;
    const bool bounds_pay = count_ > kManyMore * most;
    std::size_t taken = 0;
    while (taken < std::min(most, count_)) {
        const bool is_for_depth = has_rest && taken % 2 == 0;
        if (has_rest && !is_for_depth) {
            bring_farthest(taken);
        } else {
            bring_deepest(taken);
        }
        ContactCandidate& next = all[taken];
        const bool was_exact = next.known == Known::exactly;
        if (!was_exact) {
            const bool is_bounded = is_for_depth && bounds_pay && next.known == Known::roughly;
            if (!(is_bounded ? bound(next) : compute(next))) return take_exact(taken, most);
        }
        if (was_exact || !is_for_depth) update_gaps(taken++);
    }
    std::sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(taken), is_deeper);
    return all.first(taken);
}

}  // namespace cdprep
