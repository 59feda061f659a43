// SPDX-License-Identifier: MIT
#include "query/cached_search.h"
#include "walk/find_contact.h"

// In another file than find_contact(): where nothing else walks, the compiler inlines the whole
// walk.

namespace cdprep {

bool has_pair(const PairCache& cache, const Model& a, const Model& b) noexcept {
    return (cache.holds & held_pair) != 0 && cache.triangle_a < a.triangle_count() &&
           cache.triangle_b < b.triangle_count();
}

void remember_pair(PairCache& cache, const TreePair& pair) noexcept {
    cache.holds |= held_pair;
    cache.triangle_a = pair.a;
    cache.triangle_b = pair.b;
}

bool any_contact(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
                 const PairOptions& options, PairCache* cache) noexcept {
    if (cache == nullptr) {
        return find_contact(a, b, placement, workspace, options).has_value();
    }
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return false;
    if (still_touches(*cache, a, b, placement, options, workspace.storage().counts)) return true;
    if (proven_gap(*cache, a, b, placement) > 0) return false;
    CachedSearch search(a, b, placement, workspace, options, *cache);
    const bool touched = (cache->holds & held_touch) != 0 && has_pair(*cache, a, b);
    const LeafPlaces held = {cache->triangle_a / format::kBvhWidth,
                             cache->triangle_b / format::kBvhWidth};
    if (touched && search.touches_again(held)) return true;
    return search.walk();
}

}  // namespace cdprep
