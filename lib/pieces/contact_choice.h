// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <span>

#include "exact/vectors.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Chooses the contacts of a list with a limit: the deepest, and others spread over the surface.
///
/// Most candidates are only known to be no deeper than a bound. Those that may be the deepest are
/// computed, the one with the largest bound first.
class ContactChoice {
public:
    explicit ContactChoice(std::span<ContactCandidate> room) noexcept : room_(room) {}

    /// Adds a candidate. If there is no room, the one with the smallest bound goes.
    void add(const ContactCandidate& candidate) noexcept;

    /// Returns at most `most` candidates. If there are more, every second one is the deepest that
    /// is left, and the others are those farthest from all that were taken. `compute(candidate)`
    /// makes a candidate exact, or returns false to end the choice: then those that are exact are
    /// returned. Nothing can be added afterwards.
    template <class Compute>
    [[nodiscard]] std::span<ContactCandidate> choose(std::size_t most, Compute&& compute) noexcept;

private:
    /// By depth, then by pieces: a strict order, which does not depend on the search. Of two with
    /// equal depths, the one that is only bounded comes first, to be computed.
    static bool is_deeper(const ContactCandidate& x, const ContactCandidate& y) noexcept {
        if (x.depth != y.depth) return x.depth > y.depth;
        if (x.is_exact != y.is_exact) return y.is_exact;
        return x.near.key < y.near.key;
    }
    /// Returns the first `taken` candidates, and the deepest of the others that are exact.
    [[nodiscard]] std::span<ContactCandidate> take_exact(std::size_t taken,
                                                         std::size_t most) noexcept;
    /// Brings the candidate farthest from those before `first` there.
    void bring_farthest(std::size_t first) noexcept;
    void update_gaps(std::size_t taken) noexcept;

    std::span<ContactCandidate> room_;
    std::size_t count_ = 0;
};

template <class Compute>
std::span<ContactCandidate> ContactChoice::choose(std::size_t most, Compute&& compute) noexcept {
    const auto all = room_.first(count_);
    for (ContactCandidate& c : all) c.squared_gap = std::numeric_limits<double>::infinity();
    std::size_t taken = 0;
    while (taken < std::min(most, count_)) {
        if (count_ > most && taken % 2 == 1) {
            bring_farthest(taken);
        } else {
            // The first of the rest: the deepest once nothing else may be deeper.
            const auto rest = all.subspan(taken);
            std::iter_swap(rest.begin(), std::min_element(rest.begin(), rest.end(), is_deeper));
        }
        ContactCandidate& next = all[taken];
        const bool was_bounded = !next.is_exact;
        if (was_bounded && !compute(next)) return take_exact(taken, most);
        const bool is_settled = taken % 2 == 1 || count_ <= most || !was_bounded;
        if (!is_settled) continue;
        update_gaps(taken++);
    }
    std::sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(taken), is_deeper);
    return all.first(taken);
}

}  // namespace cdprep
