// SPDX-License-Identifier: MIT
#include "find_contact.h"

#include <algorithm>
#include <cmath>

#include "contact_pairs.h"
#include "proven_gap.h"

namespace cdprep {
namespace {

/// Boxes are apart by this share of what their test was widened by: their axes are
/// unit up to 2^-20, and the widened slack is rounded.
constexpr double kProved = 1 - 0x1p-18;

/// A gap is worth a proof when it lasts some questions: it is sought this many steps
/// wide at least.
constexpr double kLeastSteps = 2;
/// Most questions that pass after proofs that failed.
constexpr std::uint32_t kMostFailures = 4;
/// Pair units: no wider than all there is, so that float holds it.
constexpr double kGreatestMargin = 4;

/// Height of the nodes around the cached pair that are searched first: 64 leaves each.
/// Measured: one lower or higher gains less.
constexpr std::uint32_t kNearHeight = 2;

/// One question that starts from a cache.
class CachedSearch {
public:
    CachedSearch(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
                 const OverlapOptions& options, PairCache& cache) noexcept
        : a_(a),
          b_(b),
          placement_(placement),
          scratch_(workspace.storage()),
          cache_(cache),
          touch_(a, b, placement, options, scratch_.counts),
          placed_(place_boxes(a, b, placement)),
          batch_(a, b, placed_, scratch_) {}

    /// Whether anything touches near the cached pair: in the leaves that hold it, or
    /// in two nodes around them.
    bool touches_again() noexcept;
    /// Walks both hierarchies with wider boxes until that leads to a leaf; from then
    /// on with boxes as they are. When it never does, the models are so far apart.
    bool walk() noexcept;

private:
    /// After a hit the deepest boxes first, a leaf at a time; after a miss, when all is
    /// likely to be looked at, in any order, leaves together. Calls `narrow()` at leaves.
    template <class Narrow>
    bool walk_all(Narrow narrow) noexcept;

    bool look_at(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        batch_.add(leaf_a, leaf_b);
        return look_at_batch();
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
};

bool CachedSearch::touches_again() noexcept {
    const std::uint32_t leaf_a = cache_.triangle_a / format::kBvhWidth;
    const std::uint32_t leaf_b = cache_.triangle_b / format::kBvhWidth;
    if (look_at(leaf_a, leaf_b)) return true;
    const Tree a(a_);
    const Tree b(b_);
    const auto around = [](const Tree& tree, std::uint32_t leaf) {
        const std::uint32_t height = std::min(kNearHeight, tree.shape.levels);
        return TreePlace{height, leaf >> (3 * height)};
    };
    return !walk_pairs_from<Search::first>(
        {around(a, leaf_a), around(b, leaf_b)}, 0, a, b, placed_, scratch_,
        [&](const PendingPair& pair) { return !look_at(pair.a.index, pair.b.index); });
}

/// The gap to be proved, model units, or 0.
double next_margin(PairCache& cache) noexcept {
    if (cache.wait > 0) {
        --cache.wait;
        return 0;
    }
    return std::max(kLeastSteps * cache.step, cache.failures == 0 ? 2 * cache.proof : 0);
}

void note_proof(PairCache& cache, double margin, bool proved) noexcept {
    cache.proof = proved ? margin : 0;
    cache.failures = proved ? 0 : std::min(cache.failures + 1, kMostFailures);
    cache.wait = (1U << (2 * cache.failures)) - 1;
}

template <class Narrow>
bool CachedSearch::walk_all(Narrow narrow) noexcept {
    const Tree a(a_);
    const Tree b(b_);
    const bool missed = (cache_.holds & held_place) != 0 && (cache_.holds & held_touch) == 0;
    if (!missed) {
        return !walk_pairs<Search::first>(a, b, placed_, scratch_,
                                          [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
                                              narrow();
                                              return !look_at(leaf_a, leaf_b);
                                          });
    }
    return !walk_pairs<Search::all>(a, b, placed_, scratch_,
                                    [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
                                        narrow();
                                        batch_.add(leaf_a, leaf_b);
                                        return !batch_.full() || !look_at_batch();
                                    }) ||
           look_at_batch();
}

bool CachedSearch::walk() noexcept {
    const float slack = placed_.placement.slack;
    const double margin =
        std::min(std::ldexp(next_margin(cache_), placed_.exponent), kGreatestMargin);
    placed_.placement.slack += static_cast<float>(margin);
    bool proves = margin > 0 && !placed_.apart;
    const auto narrow = [&] {
        placed_.placement.slack = slack;
        proves = false;
    };
    if (walk_all(narrow)) return true;
    cache_.holds &= ~std::uint32_t{held_touch};
    const double gap = std::ldexp(margin, -placed_.exponent);
    if (margin > 0) note_proof(cache_, gap, proves);
    // Where nothing was tried, the old place still tells how far B moves a question.
    if (margin > 0 || (cache_.holds & held_place) == 0) {
        remember_gap(cache_, a_, b_, placement_, proves ? gap * kProved : 0);
    }
    if (!proves) cache_.gap = 0;
    return false;
}

}  // namespace

bool has_pair(const PairCache& cache, const Model& a, const Model& b) noexcept {
    return (cache.holds & held_pair) != 0 && cache.triangle_a < a.triangle_count() &&
           cache.triangle_b < b.triangle_count();
}

void remember_pair(PairCache& cache, const TreePair& pair) noexcept {
    cache.holds |= held_pair;
    cache.triangle_a = pair.a;
    cache.triangle_b = pair.b;
}

std::optional<TreePair> find_contact(const Model& a, const Model& b, const Placement& placement,
                                     Workspace& workspace, const OverlapOptions& options) noexcept {
    std::optional<TreePair> contact;
    for_each_contact<Search::first>(a, b, placement, workspace, options,
                                    [&](std::uint32_t at_a, std::uint32_t at_b) {
                                        contact = TreePair{at_a, at_b};
                                        return false;
                                    });
    return contact;
}

bool any_contact(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
                 const OverlapOptions& options, PairCache* cache) noexcept {
    if (cache == nullptr) {
        return find_contact(a, b, placement, workspace, options).has_value();
    }
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return false;
    if (proven_gap(*cache, a, b, placement) > 0) return false;
    CachedSearch search(a, b, placement, workspace, options, *cache);
    const bool touched = (cache->holds & held_touch) != 0 && has_pair(*cache, a, b);
    if (touched && search.touches_again()) return true;
    return search.walk();
}

}  // namespace cdprep
