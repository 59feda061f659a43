// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>

#include "walk/contact_pairs.h"
#include "walk/find_contact.h"
#include "walk/proven_gap.h"

namespace cdprep {

/// Stores whether a complete walk found contact, and where.
inline void note_contact(PairCache& cache, const Model& a, const Model& b,
                         const Placement& placement, const std::optional<TreePair>& at) noexcept {
    if (at) {
        remember_pair(cache, *at);
        cache.holds |= held_touch;
        cache.gap = 0;
    } else {
        cache.holds &= ~std::uint32_t{held_touch};
        remember_gap(cache, a, b, placement, 0);
    }
}

/// Calls `found(a, b)` as for_each_contact() does, with a cache that may be null. If the last query
/// about the pair found nothing, a search for any contact comes first. That search is not repeated
/// while the gap that it proves lasts. If it succeeds, the complete walk takes much longer than the
/// search did.
template <class Found>
bool for_each_contact(const Model& a, const Model& b, const Placement& placement,
                      Workspace& workspace, const PairOptions& options, PairCache* cache,
                      Found&& found) noexcept {
    if (cache == nullptr || a.triangle_count() == 0 || b.triangle_count() == 0) {
        return for_each_contact<Search::all>(a, b, placement, workspace, options,
                                             std::forward<Found>(found));
    }
    const bool missed = (cache->holds & held_place) != 0 && (cache->holds & held_touch) == 0;
    if (missed && !any_contact(a, b, placement, workspace, options, cache)) return true;
    std::optional<TreePair> first;
    const bool whole = for_each_contact<Search::all>(a, b, placement, workspace, options,
                                                     [&](std::uint32_t at_a, std::uint32_t at_b) {
                                                         if (!first) first = TreePair{at_a, at_b};
                                                         return found(at_a, at_b);
                                                     });
    note_contact(*cache, a, b, placement, first);
    return whole;
}

}  // namespace cdprep
