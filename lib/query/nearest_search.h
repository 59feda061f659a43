// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>

#include "cdprep/bounded_distance.h"
#include "cdprep/format/portable.h"
#include "cdprep/pairs.h"
#include "exact/exact_within.h"
#include "exact/length_of.h"
#include "exact/triangle_distance.h"
#include "pieces/front.h"
#include "walk/contact_pairs.h"
#include "walk/find_contact.h"
#include "walk/proven_gap.h"

namespace cdprep {

// Distances of two models through hierarchies of both, of any kind (walked_trees.h).

/// The quality of the limit when a search begins.
enum class Limit : std::uint8_t {
    poor,  ///< best first, after a dive for a better limit
    good,  ///< depth first: most pairs that a heap would postpone are never visited
};

inline Limit limit_by(const PairCache* cache, const Model& a, const Model& b) noexcept {
    return cache != nullptr && has_pair(*cache, a, b) ? Limit::good : Limit::poor;
}

/// A branch and bound over both hierarchies, nearest boxes first. Bounds are computed in pair units
/// and in float, each with its proven error. Triangle pairs that remain are measured in double.
template <class Trees>
class NearestSearch {
public:
    NearestSearch(const Model& a, const Model& b, const Placement& placement,
                  Workspace& workspace) noexcept
        : a_(a),
          b_(b),
          moved_a_(moved_a(a, placement)),
          moved_b_(moved_b(b, placement)),
          placed_(place_boxes(a, b, placement)),
          scratch_(workspace.storage()),
          leaves_(a, b, placed_, scratch_),
          trees_(a, b, scratch_) {}

    [[nodiscard]] TriangleDistance measure(const TreePair& at, bool tight) const noexcept {
        if (scratch_.counts != nullptr) {
            ++(tight ? scratch_.counts->measured_again : scratch_.counts->measured);
        }
        return triangle_distance(moved_a_.corners(at.a), moved_b_.corners(at.b), tight);
    }

    /// Returns measure() of a pair, as tightly as possible.
    [[nodiscard]] TriangleDistance tightened(const TreePair& at,
                                             const TriangleDistance& found) const noexcept {
        return is_tight(found) ? found : measure(at, true);
    }

    /// Decides exactly where measure() cannot decide.
    [[nodiscard]] bool is_within(const TreePair& at, double tolerance) const noexcept {
        if (scratch_.counts != nullptr) ++scratch_.counts->by_exact;
        return is_within_exactly(moved_a_.corners(at.a), moved_b_.corners(at.b), tolerance);
    }

    /// Calls `near(at)` for pairs of triangles that may be at most the limit apart. `near` returns
    /// the new limit in model units, or a negative number to end the search.
    template <class Near>
    void run(double limit, Limit known, Near&& near) noexcept;

    /// As above, best first in any case, and until the workspace is out of work. Returns whether
    /// nothing is left to be seen. `near` may end the search for good.
    template <class Near>
    bool run_best_first(double limit, Limit known, Near&& near) noexcept;
    /// Returns a lower bound of the distance of what run_best_first() did not see, of what was
    /// within the limit. Model units.
    [[nodiscard]] double unseen() const noexcept {
        return std::ldexp(double{unseen_}, -placed_.exponent);
    }

    /// As above, only below those pairs of the front whose plane does not prove a gap above the
    /// limit.
    template <class Near>
    FrontEnd run(double limit, PairFront& front, Near&& near) noexcept;
    /// Begins the front anew. Requires that nothing is nearer than the limit, or that it has been
    /// visited.
    void begin(PairFront& front, double limit) noexcept;

    /// Sets the direction between two near points, in the query's coordinates. Most other pairs are
    /// farther apart along it.
    void point(const Double3& on_a, const Double3& on_b) noexcept;

private:
    /// Returns the limit in pair units, rounded up.
    [[nodiscard]] float in_pair_units(double limit) const noexcept {
        assert(!(limit < 0));
        return float_reach(std::ldexp(limit, placed_.exponent));
    }
    /// Appends the children of a pair that are near enough; returns the new end.
    std::size_t push_children(const Tree& a, const Tree& b, const PendingPair& pair,
                              std::size_t end) noexcept;
    /// This and the functions below return false when `near` ended the search.
    template <class Near>
    bool dive(const Tree& a, const Tree& b, Near&& near) noexcept;
    template <class Near>
    bool look_by_bounds(Near&& near) noexcept;
    template <class Near>
    bool look_below(std::uint64_t pair, Near&& near) noexcept;
    template <class Near>
    bool look_at_leaves(const PendingPair& pair, Near&& near) noexcept;
    template <class Near>
    bool look_at_views(const LeafView& in_a, const LeafView& in_b, Near&& near) noexcept;

    const Model& a_;
    const Model& b_;
    MovedModel moved_a_;
    MovedModel moved_b_;
    PlacedBoxes placed_;
    Workspace::Storage& scratch_;
    LeafBatch leaves_;
    Trees trees_;
    kernels::Reach reach_{};
    float unseen_ = 0;  ///< the least bound of what is not yet seen, pair units
};

template <class Trees>
void NearestSearch<Trees>::point(const Double3& on_a, const Double3& on_b) noexcept {
    const std::array<double, 3> w = {on_b.x - on_a.x, on_b.y - on_a.y, on_b.z - on_a.z};
    const double length = length_of(w[0], w[1], w[2]);
    // Slightly below 1, so that no rounding makes the direction longer than 1.
    const double scale = (1 - 0x1p-20) / length;
    if (!std::isfinite(scale)) return;
    constexpr std::array<double, 9> kStill = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const auto turned_back = [&](const Pose* pose, float* direction) {
        const std::array<double, 9>& r = pose == nullptr ? kStill : pose->rotation();
        for (std::size_t i = 0; i < 3; ++i) {
            direction[i] =
                static_cast<float>(scale * (r[i] * w[0] + r[3 + i] * w[1] + r[6 + i] * w[2]));
        }
    };
    turned_back(moved_a_.pose, reach_.direction);
    turned_back(moved_b_.pose, reach_.direction_in_b);
}

template <class Trees>
std::size_t NearestSearch<Trees>::push_children(const Tree& a, const Tree& b,
                                                const PendingPair& pair, std::size_t end) noexcept {
    const kernels::BoxPlacement& placement = placed_.placement;
    const WaysDown descent = choose_descent(a, b, pair, [&] {
        return SizePair{box_size(a, pair.a, placement.scale_a),
                        box_size(b, pair.b, placement.scale_b)};
    });
    if (scratch_.counts != nullptr) count_step(a, b, pair, descent, *scratch_.counts);
    const TestedBoxes side_a = boxes_of(a, pair.a, descent.a);
    const TestedBoxes side_b = boxes_of(b, pair.b, descent.b);
    kernels::BoxPairFloats gaps;
    const kernels::BoundTests tests = tests_for(a, b, Prefer::swept);
    kernels::BoxPairs pairs = tests.near(placement, node_boxes(a, side_a, tests.reads_swept),
                                         node_boxes(b, side_b, tests.reads_swept),
                                         {chosen(side_a), chosen(side_b), nullptr}, reach_, gaps);
    const std::uint64_t base = PendingPair{side_a.first_below, side_b.first_below}.packed();
    for (; pairs != 0; pairs &= pairs - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(pairs));
        const std::uint64_t i = bit % format::kBvhWidth;
        const std::uint64_t j = bit / format::kBvhWidth;
        // Damaged boxes may give NaN, but sorting requires ordered bounds.
        const float bound = gaps.value[j][i] > 0 ? gaps.value[j][i] : 0;
        assert(end < scratch_.near.size());
        scratch_.near[end++] = {bound, base + (i << 32) + j};
    }
    return end;
}

template <class Trees>
template <class Near>
bool NearestSearch<Trees>::look_at_leaves(const PendingPair& pair, Near&& near) noexcept {
    return trees_.each_pair(leaves_, pair.a.index, pair.b.index,
                            [&](const LeafView& in_a, const LeafView& in_b) {
                                return look_at_views(in_a, in_b, near);
                            });
}

template <class Trees>
template <class Near>
bool NearestSearch<Trees>::look_at_views(const LeafView& in_a, const LeafView& in_b,
                                         Near&& near) noexcept {
    const std::span<kernels::TriangleGap> gaps = leaves_.near_triangles(in_a, in_b, reach_);
    std::sort(gaps.begin(), gaps.end(), [](const auto& x, const auto& y) {
        if (x.lower != y.lower) return x.lower < y.lower;
        return x.b != y.b ? x.b < y.b : x.a < y.a;
    });
    for (const kernels::TriangleGap& gap : gaps) {
        if (gap.lower > reach_.limit) break;
        const double limit =
            near(TreePair{trees_.triangle_a(in_a.number * format::kBvhWidth + gap.a),
                          trees_.triangle_b(in_b.number * format::kBvhWidth + gap.b)});
        if (limit < 0) return false;
        reach_.limit = in_pair_units(limit);
    }
    return true;
}

/// A queue of box pairs, nearest first. An entry is one number: the bits of the bound, then the
/// index of the pair. The bits order as the bounds do, because bounds are not negative. Most pairs
/// are never taken out again. So a heap holds only the nearest, and the others wait in no order.
class Frontier {
public:
    explicit Frontier(Workspace::Storage& scratch) noexcept
        : soon_(scratch.frontier), later_(scratch.frontier_later), pairs_(scratch.frontier_pairs) {}

    [[nodiscard]] bool empty() const noexcept {
        return soon_count_ + later_count_ == 0;
    }
    [[nodiscard]] bool has_room_for(std::size_t count) const noexcept {
        return used_ + count <= pairs_.size();
    }
    void push(const NearPair& pair) noexcept {
        assert(has_room_for(1));
        assert(pair.bound >= 0);  // so its bits order as it does
        const std::uint64_t entry = entry_of(pair.bound, used_);
        pairs_[used_++] = pair.pair;
        if (entry > cut_) {
            later_[later_count_++] = entry;
            return;
        }
        soon_[soon_count_++] = entry;
        std::push_heap(soon_.begin(), end_of_soon(), std::greater());
    }
    /// `limit` is the reach of the search; it only shrinks.
    NearPair pop(float limit) noexcept {
        assert(!empty());
        if (soon_count_ == 0) refill(limit);
        std::pop_heap(soon_.begin(), end_of_soon(), std::greater());
        const std::uint64_t entry = soon_[--soon_count_];
        return {bound_of(entry), pairs_[static_cast<std::uint32_t>(entry)]};
    }

private:
    static float bound_of(std::uint64_t entry) noexcept {
        return format::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32));
    }
    static std::uint64_t entry_of(float bound, std::uint32_t at) noexcept {
        return std::uint64_t{format::bit_cast<std::uint32_t>(bound)} << 32 | at;
    }
    /// Returns the greatest entry with this bound.
    static std::uint64_t last_of(float bound) noexcept {
        return entry_of(bound, 0xffffffff);
    }
    [[nodiscard]] std::span<std::uint64_t>::iterator end_of_soon() const noexcept {
        return soon_.begin() + static_cast<std::ptrdiff_t>(soon_count_);
    }
    /// Makes a heap of the waiting entries up to twice the least bound, or up to the limit.
    void refill(float limit) noexcept {
        assert(soon_count_ == 0 && later_count_ > 0);
        const auto waiting = later_.first(later_count_);
        const std::uint64_t least = *std::min_element(waiting.begin(), waiting.end());
        const float widest = 2 * bound_of(least);
        cut_ = std::max(last_of(std::min(widest, limit)), least);
        later_count_ = 0;
        for (const std::uint64_t entry : waiting) {
            const bool is_soon = entry <= cut_;
            soon_[soon_count_] = entry;
            later_[later_count_] = entry;
            soon_count_ += is_soon ? 1 : 0;
            later_count_ += is_soon ? 0 : 1;
        }
        std::make_heap(soon_.begin(), end_of_soon(), std::greater());
    }

    std::span<std::uint64_t> soon_;
    std::span<std::uint64_t> later_;
    std::span<std::uint64_t> pairs_;
    std::size_t soon_count_ = 0;
    std::size_t later_count_ = 0;
    std::uint64_t cut_ = last_of(0);
    std::uint32_t used_ = 0;
};

/// Descends to the nearest child at each step. The limit that this finds keeps most pairs out of
/// the frontier.
template <class Trees>
template <class Near>
bool NearestSearch<Trees>::dive(const Tree& a, const Tree& b, Near&& near) noexcept {
    PendingPair pair{{a.shape.levels, 0}, {b.shape.levels, 0}};
    while (pair.a.height > 0 || pair.b.height > 0) {
        if (scratch_.is_out_of_work()) return false;
        const std::size_t end = push_children(a, b, pair, 0);
        if (end == 0) return true;
        const auto nearest = std::min_element(
            scratch_.near.begin(), scratch_.near.begin() + static_cast<std::ptrdiff_t>(end),
            [](const NearPair& x, const NearPair& y) { return x.bound < y.bound; });
        // The children of the roots hold everything that is within the limit.
        if (pair.a.height == a.shape.levels && pair.b.height == b.shape.levels) {
            unseen_ = nearest->bound;
        }
        pair = PendingPair::unpacked(nearest->pair);
    }
    return look_at_leaves(pair, near);
}

/// Searches depth first, nearest children first.
template <class Trees>
template <class Near>
bool NearestSearch<Trees>::look_below(std::uint64_t pair, Near&& near) noexcept {
    const auto at = [&](std::size_t index) {
        return scratch_.near.begin() + static_cast<std::ptrdiff_t>(index);
    };
    scratch_.near[0] = {0, pair};
    for (std::size_t depth = 1; depth > 0;) {
        const NearPair top = scratch_.near[--depth];
        if (top.bound > reach_.limit) continue;
        if (scratch_.is_out_of_work()) return false;
        const PendingPair places = PendingPair::unpacked(top.pair);
        if (places.a.height == 0 && places.b.height == 0) {
            if (!look_at_leaves(places, near)) return false;
            continue;
        }
        const std::size_t end = push_children(trees_.a, trees_.b, places, depth);
        std::sort(at(depth), at(end),
                  [](const NearPair& x, const NearPair& y) { return x.bound > y.bound; });
        depth = end;
    }
    return true;
}

/// Searches best first, unless the limit is good.
template <class Trees>
template <class Near>
void NearestSearch<Trees>::run(double limit, Limit known, Near&& near) noexcept {
    const Tree& a = trees_.a;
    const Tree& b = trees_.b;
    if (a.triangles == 0 || b.triangles == 0) return;
    reach_.limit = in_pair_units(limit);
    const std::uint64_t both = roots(a, b).packed();
    if (known == Limit::good) {
        look_below(both, near);
        return;
    }
    if (dive(a, b, near)) look_by_bounds(near);
}

template <class Trees>
template <class Near>
bool NearestSearch<Trees>::run_best_first(double limit, Limit known, Near&& near) noexcept {
    unseen_ = 0;
    if (trees_.a.triangles == 0 || trees_.b.triangles == 0) return true;
    reach_.limit = in_pair_units(limit);
    if (known == Limit::poor && !dive(trees_.a, trees_.b, near)) return false;
    return look_by_bounds(near);
}

// Pairs for which the frontier has no room are searched depth first.
//
// All pairs that are not seen yet are below those of the frontier, or were beyond an earlier limit.
// So the least bound of the frontier holds for all of them, and for those of later frontiers.
template <class Trees>
template <class Near>
bool NearestSearch<Trees>::look_by_bounds(Near&& near) noexcept {
    Frontier frontier(scratch_);
    frontier.push({0, roots(trees_.a, trees_.b).packed()});
    while (!frontier.empty()) {
        const NearPair top = frontier.pop(reach_.limit);
        if (top.bound > reach_.limit) return true;  // and so are all others
        unseen_ = std::max(unseen_, top.bound);
        if (scratch_.is_out_of_work()) return false;
        const PendingPair pair = PendingPair::unpacked(top.pair);
        if ((pair.a.height == 0 && pair.b.height == 0) ||
            !frontier.has_room_for(std::size_t{format::kBvhWidth} * format::kBvhWidth)) {
            if (!look_below(top.pair, near)) return false;
            continue;
        }
        const std::size_t end = push_children(trees_.a, trees_.b, pair, 0);
        for (std::size_t i = 0; i < end; ++i) frontier.push(scratch_.near[i]);
    }
    return true;
}

template <class Trees>
template <class Near>
FrontEnd NearestSearch<Trees>::run(double limit, PairFront& front, Near&& near) noexcept {
    reach_.limit = in_pair_units(limit);
    Front between(front, a_, b_, placed_, leaves_, trees_, scratch_, reach_.direction);
    return between.open_near(
        reach_.limit, [&](const PendingPair& pair) { return look_below(pair.packed(), near); });
}

template <class Trees>
void NearestSearch<Trees>::begin(PairFront& front, double limit) noexcept {
    reach_.limit = in_pair_units(limit);
    Front between(front, a_, b_, placed_, leaves_, trees_, scratch_, reach_.direction);
    between.begin();
    (void)between.open_near(reach_.limit, [](const PendingPair& /*pair*/) { return true; });
}

/// The nearest pairs so far that may still turn out to be the nearest.
template <class Trees>
class Nearest {
public:
    Nearest(const Model& a, const Model& b, NearestSearch<Trees>& search,
            const DistanceOptions& options) noexcept
        : a_(a), b_(b), search_(search), options_(options) {}

    /// Takes a pair before the search, which may meet it again.
    void start_from(const TreePair& at) noexcept {
        take(at);
        seed_ = at;
    }
    /// Takes a pair; returns the limit beyond which nothing is of interest.
    double take(const TreePair& at) noexcept {
        if (at.a == seed_.a && at.b == seed_.b) return limit();
        const TriangleDistance d = search_.measure(at, false);
        if (d.lower > limit()) return limit();
        may_touch_ = may_touch_ || !(d.lower > 0);
        if (d.upper < upper_) {
            upper_ = d.upper;
            search_.point(d.on_a, d.on_b);
        }
        if (count_ == contenders_.size()) settle();
        assert(count_ < contenders_.size());
        contenders_[count_++] = {at, d};
        return limit();
    }

    /// While no pair is certainly within max_distance, a permitted error must not lower the limit:
    /// the nearest so far may turn out to be too far.
    [[nodiscard]] double limit() const noexcept {
        if (upper_ > options_.max_distance) return options_.max_distance;
        if (upper_ == std::numeric_limits<double>::infinity()) return options_.max_distance;
        const double nearer =
            std::min(upper_ / (1 + options_.relative_error), upper_ - options_.absolute_error);
        return std::min(options_.max_distance, std::max(0.0, nearer));
    }

    /// Returns the answer when the search has ended.
    [[nodiscard]] std::optional<Distance> answer() noexcept {
        settle();
        // Of pairs that are equally near, up to rounding, another may be within max_distance.
        if (!found_ || lower_ > options_.max_distance) return std::nullopt;
        const double unseen =
            options_.relative_error > 0 || options_.absolute_error > 0 ? limit() : best_.upper;
        best_.lower = std::min(lower_, unseen);
        return best_;
    }
    /// Returns the nearest pair so far, for a search that ended early. What it has not seen is at
    /// least `unseen` away, or beyond the limit. Measures nothing again.
    [[nodiscard]] BoundedDistance answer_so_far(double unseen) noexcept {
        double lower = std::min({unseen, lower_, limit()});
        for (std::size_t i = 0; i < count_; ++i) {
            const auto& [at, d] = contenders_[i];
            lower = std::min(lower, d.lower);
            if (found_ && best_.upper <= d.upper) continue;
            best_ = as_answer(at, d);
            nearest_ = at;
            found_ = true;
        }
        BoundedDistance so_far;
        so_far.lower = lower;
        if (!found_) return so_far;
        so_far.upper = best_.upper;
        best_.lower = lower;
        so_far.nearest = best_;
        return so_far;
    }
    [[nodiscard]] const TreePair& nearest() const noexcept {
        return nearest_;
    }
    /// Returns whether a pair may touch; then contact must be searched for.
    [[nodiscard]] bool may_touch() const noexcept {
        return may_touch_;
    }

private:
    struct Contender {
        TreePair at;
        TriangleDistance found;
    };

    /// Measures the possible nearest pairs again, as tightly as possible.
    void settle() noexcept {
        for (std::size_t i = 0; i < count_; ++i) {
            if (contenders_[i].found.lower > upper_) continue;
            const TreePair at = contenders_[i].at;
            const TriangleDistance d = search_.tightened(at, contenders_[i].found);
            lower_ = std::min(lower_, d.lower);
            const Distance found = as_answer(at, d);
            if (found_ && !precedes(found, best_)) continue;
            best_ = found;
            nearest_ = at;
            found_ = true;
            upper_ = std::min(upper_, d.upper);
        }
        count_ = 0;
    }
    [[nodiscard]] Distance as_answer(const TreePair& at, const TriangleDistance& d) const noexcept {
        return {d.lower, d.upper, d.on_a, d.on_b, source_number(a_, at.a), source_number(b_, at.b)};
    }
    static bool precedes(const Distance& x, const Distance& y) noexcept {
        if (x.upper != y.upper) return x.upper < y.upper;
        return x.triangle_a != y.triangle_a ? x.triangle_a < y.triangle_a
                                            : x.triangle_b < y.triangle_b;
    }

    const Model& a_;
    const Model& b_;
    NearestSearch<Trees>& search_;
    const DistanceOptions& options_;
    std::array<Contender, 64> contenders_;
    std::size_t count_ = 0;
    TreePair seed_ = {format::kMaxTriangles, format::kMaxTriangles};  ///< none
    double upper_ = std::numeric_limits<double>::infinity();
    double lower_ = std::numeric_limits<double>::infinity();
    bool found_ = false;
    bool may_touch_ = false;
    Distance best_{};
    TreePair nearest_{};
};

inline Distance touching(const Model& a, const Model& b, const Placement& placement,
                         const TreePair& at) noexcept {
    const MovedModel in_a = moved_a(a, placement);
    const MovedModel in_b = moved_b(b, placement);
    const Double3 point = common_point(in_a.corners(at.a), in_b.corners(at.b));
    return {0, 0, point, point, source_number(a, at.a), source_number(b, at.b)};
}

template <class Trees>
std::optional<Distance> distance_by(const Pair& pair, Workspace& workspace,
                                    const DistanceOptions& options) noexcept;

/// The answer of a front, if it could answer.
struct FrontDistance {
    bool answered = false;
    std::optional<Distance> distance;
};

inline void remember_distance(PairCache& cache, const Model& a, const Model& b,
                              const Placement& placement, const TreePair& at,
                              const Distance& found) noexcept {
    remember_pair(cache, at);
    remember_gap(cache, a, b, placement, found.lower);
}

/// Answers through the front unless the models touch or have jumped. Requires a front of these
/// models.
template <class Trees>
FrontDistance distance_by_front(const Model& a, const Model& b, const Placement& placement,
                                Workspace& workspace, const DistanceOptions& options,
                                PairCache& cache, PairFront& front) noexcept {
    NearestSearch<Trees> search(a, b, placement, workspace);
    Nearest<Trees> nearest(a, b, search, options);
    if (has_pair(cache, a, b)) nearest.start_from({cache.triangle_a, cache.triangle_b});
    if (nearest.may_touch() || !std::isfinite(nearest.limit())) return {};
    const FrontEnd end = search.run(nearest.limit(), front, [&](const TreePair& at) {
        const double limit = nearest.take(at);
        return nearest.may_touch() ? -1 : limit;
    });
    if (end != FrontEnd::whole) return {};
    const std::optional<Distance> found = nearest.answer();
    if (found) remember_distance(cache, a, b, placement, nearest.nearest(), *found);
    return {true, found};
}

/// Returns the distance if one solid is inside the other: 0. The witnesses are the nearest points
/// of the surfaces.
template <class Trees>
std::optional<Distance> inside(const Pair& pair, Workspace& workspace) noexcept {
    const Pair surfaces = {pair.a, pair.b, pair.placement, {}, pair.cache, pair.front};
    std::optional<Distance> walls = distance_by<Trees>(surfaces, workspace, {});
    if (walls) walls->lower = walls->upper = 0;
    return walls;
}

template <class Trees>
std::optional<Distance> distance_by(const Pair& pair, Workspace& workspace,
                                    const DistanceOptions& options) noexcept {
    const Model &a = pair.a, &b = pair.b;
    const Placement& placement = pair.placement;
    PairCache* const cache = pair.cache;
    // A front does not tell whether one solid is inside the other.
    const bool may_use_front = cache != nullptr && pair.options.body == Body::surface;
    PairFront* const front = may_use_front ? pair.front : nullptr;
    if (!(options.max_distance >= 0)) return std::nullopt;
    if constexpr (Trees::kHasHulls) {
        if (front != nullptr && is_of(*front, a, b)) {
            const FrontDistance found =
                distance_by_front<Trees>(a, b, placement, workspace, options, *cache, *front);
            if (found.answered) return found.distance;
        }
    }
    // The cached pair must not decide which of several touching pairs is the answer.
    const bool apart = cache != nullptr && proven_gap(*cache, a, b, placement) > 0;
    if (!apart) {
        if (const auto at = find_contact_by<Trees>(a, b, placement, workspace, {})) {
            if (cache != nullptr) remember_pair(*cache, *at);
            return touching(a, b, placement, *at);
        }
    }
    if (pair.options.body == Body::solid && containment(pair, workspace).answer == Answer::yes) {
        return inside<Trees>(pair, workspace);
    }
    NearestSearch<Trees> search(a, b, placement, workspace);
    Nearest<Trees> nearest(a, b, search, options);
    const Limit known = limit_by(cache, a, b);
    if (known == Limit::good) nearest.start_from({cache->triangle_a, cache->triangle_b});
    search.run(nearest.limit(), known, [&](const TreePair& at) { return nearest.take(at); });
    const std::optional<Distance> found = nearest.answer();
    if (found && cache != nullptr) {
        remember_distance(*cache, a, b, placement, nearest.nearest(), *found);
    }
    if constexpr (Trees::kHasHulls) {
        const double far = found ? found->upper : options.max_distance;
        if (front != nullptr && std::isfinite(far) && is_time_to_begin(*front)) {
            search.begin(*front, far);
        }
    }
    return found;
}

/// Requires a tolerance above 0.
template <class Trees>
bool is_within_by(const Model& a, const Model& b, const Placement& placement, double tolerance,
                  Workspace& workspace, PairCache* cache, PairFront* front = nullptr) noexcept {
    const double gap = cache == nullptr ? 0 : proven_gap(*cache, a, b, placement);
    if (gap > tolerance) return false;
    NearestSearch<Trees> search(a, b, placement, workspace);
    bool within = false;
    double nearest = std::numeric_limits<double>::infinity();
    const auto look = [&](const TreePair& at) {
        const auto undecided = [&](const TriangleDistance& of) {
            return of.lower <= tolerance && of.upper > tolerance;
        };
        TriangleDistance d = search.measure(at, false);
        if (undecided(d)) d = search.tightened(at, d);
        if (d.lower > tolerance || (undecided(d) && !search.is_within(at, tolerance))) {
            if (d.upper < nearest) {
                nearest = d.upper;
                search.point(d.on_a, d.on_b);
            }
            return tolerance;
        }
        within = true;
        if (cache != nullptr) remember_pair(*cache, at);
        return -1.0;
    };
    const Limit known = limit_by(cache, a, b);
    if (known == Limit::good && look({cache->triangle_a, cache->triangle_b}) < 0) return true;
    if constexpr (Trees::kHasHulls) {
        if (front != nullptr && is_of(*front, a, b) &&
            search.run(tolerance, *front, look) != FrontEnd::lost) {
            return within;
        }
    }
    if (!(gap > 0) && find_contact_by<Trees>(a, b, placement, workspace, {})) return true;
    search.run(tolerance, known, look);
    if constexpr (Trees::kHasHulls) {
        if (front != nullptr && !within && is_time_to_begin(*front))
            search.begin(*front, tolerance);
    }
    return within;
}

}  // namespace cdprep
