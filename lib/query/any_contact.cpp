// SPDX-License-Identifier: MIT
#include "query/cached_search.h"
#include "walk/find_contact.h"

// In another file than find_contact(): where nothing else walks, the compiler inlines the whole
// walk.

namespace cdprep {

bool has_pair(const PairCache& cache, const Model& a, const Model& b) noexcept {
    return (cache.holds & held_pair) != 0 && has_triangle(a, cache.triangle_a) &&
           has_triangle(b, cache.triangle_b);
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
    if (touched && search.touches_again()) return true;
    return search.walk();
}

bool any_contact_near(TreePair& touched, const Pair& pair, Workspace& workspace) noexcept {
    const Model &a = pair.a, &b = pair.b;
    if (has_triangle(a, touched.a) && has_triangle(b, touched.b)) {
        PairCache cache;
        remember_pair(cache, touched);
        CachedSearch search(a, b, pair.placement, workspace, pair.options, cache);
        const bool touches = search.touches_again();
        touched = {cache.triangle_a, cache.triangle_b};
        if (touches) return true;
    }
    // No gap is proved here: most pairs that do not touch are never asked again. A proof takes
    // twice as long as a walk.
    const auto found = find_contact(a, b, pair.placement, workspace, pair.options);
    touched = found.value_or(kNoPair);
    return found.has_value();
}

namespace {

/// Prefetches the leaf of a triangle and the nodes in which touches_again() begins.
void prefetch_near(const Model& model, std::uint32_t triangle) noexcept {
    if (!has_triangle(model, triangle)) return;
    const Tree tree(model);
    const std::uint32_t leaf = triangle / format::kBvhWidth;
    prefetch(&model.bvh().leaves[leaf]);
    TreePlace below = {0, leaf};
    for (; below.height < std::min(kNearHeight, tree.shape.levels); ++below.height) {
        below.index /= format::kBvhWidth;
        const std::uint32_t node = tree.shape.first[below.height] + below.index;
        prefetch(&tree.nodes[node]);
        if (tree.oriented != nullptr) prefetch(&tree.oriented[node]);
    }
}

}  // namespace

void prefetch_contact(const TreePair& touched, const Model& a, const Model& b) noexcept {
    prefetch_near(a, touched.a);
    prefetch_near(b, touched.b);
}

}  // namespace cdprep
