// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "walk/contact_pairs.h"
#include "walk/proven_gap.h"

namespace cdprep {

/// The proved share of the amount by which a box test was widened. The axes are unit up to 2^-20,
/// and a sum with the amount is rounded.
inline constexpr double kProved = 1 - 0x1p-18;

/// The least width of a gap to be proved, in steps: a proof is worthwhile if the gap lasts several
/// queries.
inline constexpr double kLeastSteps = 2;
/// The number of failed proofs beyond which the wait for the next proof does not grow.
inline constexpr std::uint32_t kMostFailures = 4;
/// The greatest margin in pair units: no wider than all boxes together, so that float can hold it.
inline constexpr double kGreatestMargin = 4;

/// The height of the nodes around the cached pair that are searched first: 64 leaves each. In
/// measurements, one level lower or higher gains less.
inline constexpr std::uint32_t kNearHeight = 2;

/// Returns whether the cached pair of triangles touched and still does.
inline bool still_touches(const PairCache& cache, const Model& a, const Model& b,
                          const Placement& placement, const PairOptions& options,
                          QueryCounts* counts) noexcept {
    if ((cache.holds & held_touch) == 0 || !has_pair(cache, a, b)) return false;
    const ContactTest touch(a, b, placement, options, counts);
    return touch(cache.triangle_a, cache.triangle_b, false);
}

/// One query that starts from a cache.
class CachedSearch {
public:
    CachedSearch(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
                 const PairOptions& options, PairCache& cache) noexcept
        : a_(a),
          b_(b),
          placement_(placement),
          scratch_(workspace.storage()),
          cache_(cache),
          touch_(a, b, placement, options, scratch_.counts),
          placed_(place_boxes(a, b, placement)),
          batch_(a, b, placed_, scratch_),
          trees_(a, b, scratch_) {}

    /// Returns whether anything touches in the leaves of the cached pair, or in two nodes around
    /// them.
    bool touches_again() noexcept;
    /// Returns whether anything touches. Walks both hierarchies with boxes widened by the gap to be
    /// proved until it reaches a leaf, and with unwidened boxes from then on. If it reaches none,
    /// the gap is proved.
    bool walk() noexcept;

private:
    /// Walks all. After a hit: the deepest boxes first, one leaf pair at a time. After a miss,
    /// probably everything is visited: in any order, leaf pairs tested together. Calls `narrow()`
    /// at leaves.
    template <class Narrow>
    bool walk_all(Narrow narrow) noexcept;

    /// Returns whether a contact was found; tests the batch when it is full.
    bool add(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        return !trees_.each_pair(batch_, leaf_a, leaf_b, [&](const LeafView& a, const LeafView& b) {
            batch_.add(a, b);
            return !batch_.full() || !look_at_batch();
        });
    }
    bool look_at(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        return add(leaf_a, leaf_b) || look_at_batch();
    }
    bool look_at_batch() noexcept {
        return !batch_.flush([&](std::uint32_t at_a, std::uint32_t at_b, bool certain) {
            if (!touch_(at_a, at_b, certain)) return true;
            remember_pair(cache_, {at_a, at_b});
            cache_.holds |= held_touch;
            cache_.gap = 0;
            return false;
        });
    }

    const Model& a_;
    const Model& b_;
    const Placement& placement_;
    Workspace::Storage& scratch_;
    PairCache& cache_;
    ContactTest touch_;
    PlacedBoxes placed_;
    LeafBatch batch_;
    TriangleTrees trees_;
};

inline bool CachedSearch::touches_again() noexcept {
    const std::uint32_t leaf_a = cache_.triangle_a / format::kBvhWidth;
    const std::uint32_t leaf_b = cache_.triangle_b / format::kBvhWidth;
    if (look_at(leaf_a, leaf_b)) return true;
    const auto around = [](const Tree& tree, std::uint32_t leaf) {
        const std::uint32_t height = std::min(kNearHeight, tree.shape.levels);
        return TreePlace{height, leaf >> (3 * height)};
    };
    const PendingPair nodes = {around(trees_.a, leaf_a), around(trees_.b, leaf_b)};
    const auto miss = [&](const PendingPair& leaves) {
        const bool is_known = leaves.a.index == leaf_a && leaves.b.index == leaf_b;
        return is_known || !look_at(leaves.a.index, leaves.b.index);
    };
    return !walk_pairs_from<Search::first>(nodes, 0, trees_.a, trees_.b, placed_, scratch_, miss);
}

/// Returns the gap to be proved, in model units, or 0.
inline double next_margin(PairCache& cache) noexcept {
    if (cache.wait > 0) {
        --cache.wait;
        return 0;
    }
    return std::max(kLeastSteps * cache.step, cache.failures == 0 ? 2 * cache.proof : 0);
}

inline void note_proof(PairCache& cache, double margin, bool proved) noexcept {
    cache.proof = proved ? margin : 0;
    cache.failures = proved ? 0 : std::min(cache.failures + 1, kMostFailures);
    cache.wait = (1U << (2 * cache.failures)) - 1;
}

template <class Narrow>
bool CachedSearch::walk_all(Narrow narrow) noexcept {
    const bool missed = (cache_.holds & held_place) != 0 && (cache_.holds & held_touch) == 0;
    if (!missed) {
        return !walk_pairs<Search::first>(trees_.a, trees_.b, placed_, scratch_,
                                          [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
                                              narrow();
                                              return !look_at(leaf_a, leaf_b);
                                          });
    }
    return !walk_pairs<Search::all>(trees_.a, trees_.b, placed_, scratch_,
                                    [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
                                        narrow();
                                        return !add(leaf_a, leaf_b);
                                    }) ||
           look_at_batch();
}

inline bool CachedSearch::walk() noexcept {
    const double margin =
        std::min(std::ldexp(next_margin(cache_), placed_.exponent), kGreatestMargin);
    placed_.placement.tolerance = static_cast<float>(margin);
    bool proves = margin > 0 && !placed_.apart;
    const auto narrow = [&] {
        placed_.placement.tolerance = 0;
        proves = false;
    };
    if (walk_all(narrow)) return true;
    cache_.holds &= ~std::uint32_t{held_touch};
    const double gap = std::ldexp(margin, -placed_.exponent);
    if (margin > 0) note_proof(cache_, gap, proves);
    // If no proof was tried, the old place still gives B's motion per query.
    if (margin > 0 || (cache_.holds & held_place) == 0) {
        remember_gap(cache_, a_, b_, placement_, proves ? gap * kProved : 0);
    }
    if (!proves) cache_.gap = 0;
    return false;
}

}  // namespace cdprep
