// SPDX-License-Identifier: MIT
#include "hull/gjk.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/numbers.h"
#include "exact/length_of.h"

// The lower bound trusts no step of the search. For any direction d, the planes across it through
// the farthest points of A and B are d . (b - a) / |d| apart. Let p - q be a corner of the simplex.
// No point of A is farther along -d from p than the first bound of MovedHull::proven(). No point of
// B is farther along d from q than the second. The upper bound is the length of a sum of corners
// with non-negative weights.

namespace cdprep {
namespace {

/// Of a search in double: limits its time. What it leaves open is decided exactly.
constexpr int kMostSteps = 64;

/// A direction whose largest coordinate is 1 in size.
struct Direction {
    Double3 at;
    double length;
    bool is_one;  ///< false for no direction
};

Direction direction_of(const NearestSimplex& simplex) {
    const Double3 d = nearest_direction(simplex);
    const double most = largest_of(d);
    if (!(most > 0 && most < kInfinity)) return {{}, 0, false};
    const Double3 scaled = {d.x / most, d.y / most, d.z / most};
    return {scaled, std::sqrt(dot(scaled, scaled)), true};
}

double largest_corner(const NearestSimplex& simplex) {
    double most = 0;
    for (std::size_t i = 0; i < simplex.count; ++i) {
        most = std::max(most, largest_of(simplex.corner[i].at));
    }
    return most;
}

class Search {
public:
    Search(const MovedHull& a, const MovedHull& b, const GjkGoal& goal) noexcept
        : a_(a), b_(b), goal_(goal) {}

    void start(const ConvexCache* cache) noexcept;
    GjkVerdict run() noexcept;

    [[nodiscard]] GjkResult result(GjkVerdict verdict) const noexcept {
        const double upper = verdict == GjkVerdict::meet ? kInfinity : upper_bound(simplex_);
        return {verdict, std::max(0.0, lower_), upper, simplex_};
    }
    [[nodiscard]] std::uint64_t steps() const noexcept {
        return steps_;
    }
    /// Stores where the search ended.
    void remember(ConvexCache& cache) const noexcept;

private:
    [[nodiscard]] Difference difference(std::uint32_t i, std::uint32_t j) const noexcept {
        const Double3 p = a_.point(i);
        const Double3 q = b_.point(j);
        return {i, j, p, q, p - q};
    }
    [[nodiscard]] bool takes(const ConvexCache& cache) noexcept;
    /// Returns the corner that is lowest along a direction.
    [[nodiscard]] Difference lowest(const Direction& d) noexcept {
        ++steps_;
        near_a_ = is_warm_ ? a_.farthest(-d.at, near_a_) : a_.farthest_anew(-d.at, near_a_);
        near_b_ = is_warm_ ? b_.farthest(d.at, near_b_) : b_.farthest_anew(d.at, near_b_);
        return difference(near_a_, near_b_);
    }
    /// Adds a corner. Returns false when the simplex came no nearer.
    [[nodiscard]] bool add(const Difference& corner) noexcept;
    /// Proves a lower bound along a direction.
    void prove(const Direction& d) noexcept;
    [[nodiscard]] GjkVerdict proved(const Direction& d) noexcept {
        prove(d);
        return lower_ > 0 ? GjkVerdict::apart : GjkVerdict::unsure;
    }

    const MovedHull& a_;
    const MovedHull& b_;
    const GjkGoal& goal_;
    NearestSimplex simplex_;
    double squared_ = kInfinity;  ///< of the nearest point's distance
    double lower_ = 0;
    std::uint32_t near_a_ = 0;
    std::uint32_t near_b_ = 0;
    bool is_warm_ = false;       ///< began where an earlier query ended
    bool ended_by_gap_ = false;  ///< by a proof that the distance exceeds goal_.farther
    std::uint64_t steps_ = 0;
};

bool Search::takes(const ConvexCache& cache) noexcept {
    if (cache.count == 0 || cache.count > 4) return false;
    for (std::size_t i = 0; i < cache.count; ++i) {
        if (cache.a[i] >= a_.count() || cache.b[i] >= b_.count()) return false;
    }
    for (std::size_t i = 0; i < cache.count; ++i) {
        if (simplex_.has(cache.a[i], cache.b[i])) continue;
        simplex_.corner[simplex_.count++] = difference(cache.a[i], cache.b[i]);
    }
    return true;
}

void Search::start(const ConvexCache* cache) noexcept {
    is_warm_ = cache != nullptr && takes(*cache);
    if (!is_warm_) {
        const Double3 way = a_.point(0) - b_.point(0);
        simplex_.corner[simplex_.count++] =
            difference(a_.farthest_anew(-way, 0), b_.farthest_anew(way, 0));
    }
    near_a_ = simplex_.corner[0].a;
    near_b_ = simplex_.corner[0].b;
    keep_nearest(simplex_);
    const Double3 nearest = weighted_point(simplex_);
    squared_ = dot(nearest, nearest);
}

bool Search::add(const Difference& corner) noexcept {
    assert(simplex_.count < 4);
    NearestSimplex next = simplex_;
    next.corner[next.count++] = corner;
    keep_nearest(next);
    const Double3 nearest = weighted_point(next);
    const double squared = dot(nearest, nearest);
    if (next.count < 4 && !(squared < squared_)) return false;
    simplex_ = next;
    squared_ = squared;
    return true;
}

void Search::prove(const Direction& d) noexcept {
    assert(simplex_.count > 0);
    const Difference& from = simplex_.corner[0];
    const double of_a = a_.proven(-d.at, from.at_a, near_a_).bound;
    const double of_b = b_.proven(d.at, from.at_b, near_b_).bound;
    const double whole = dot(d.at, from.at);
    // 4 u for the difference and the dot product, 2 u for what follows.
    const double size = dot_size(d.at, from.at) + std::fabs(of_a) + std::fabs(of_b);
    constexpr double kUnderflow = 0x1p-1050;  // more than products below the range of double lose
    const double gap = whole - of_a - of_b - 8 * kUnit * size - kUnderflow;
    lower_ = std::max(lower_, gap / d.length * (1 - 8 * kUnit));
}

GjkVerdict Search::run() noexcept {
    for (;;) {
        if (simplex_.count == 4) {
            return certainly_encloses_origin(simplex_) ? GjkVerdict::meet : GjkVerdict::unsure;
        }
        if (goal_.nearer >= 0 && upper_bound(simplex_) <= goal_.nearer) return GjkVerdict::unsure;
        const Direction d = direction_of(simplex_);
        if (!d.is_one) return GjkVerdict::unsure;
        const Difference corner = lowest(d);
        const double here = dot(d.at, simplex_.corner[0].at) / d.length;
        const double beyond = dot(d.at, corner.at) / d.length;
        const double rounding = 16 * kUnit * std::max(largest_corner(simplex_), 0x1p-500);
        if (beyond > goal_.farther + rounding) {
            prove(d);
            ended_by_gap_ = lower_ > goal_.farther;
            if (ended_by_gap_) return GjkVerdict::apart;
        }
        const double permitted =
            std::max({goal_.relative_error * here * 0.5, goal_.absolute_error * 0.5, rounding});
        if (here - beyond <= permitted || simplex_.has(corner.a, corner.b) || steps_ > kMostSteps ||
            !add(corner)) {
            return proved(d);
        }
    }
}

void Search::remember(ConvexCache& cache) const noexcept {
    cache.count = 0;
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
        cache.a[cache.count] = a;
        cache.b[cache.count++] = b;
    };
    // The pair that proved the gap is the start of the next climb and one more corner of the next
    // simplex.
    if (ended_by_gap_) add(near_a_, near_b_);
    for (std::size_t i = 0; i < simplex_.count; ++i) {
        if (cache.count < 4) add(simplex_.corner[i].a, simplex_.corner[i].b);
    }
}

}  // namespace

double upper_bound(const NearestSimplex& simplex) noexcept {
    // The corners and the weights are off by u, their sums by 3 u, the sum of the weights by 4 u.
    const Double3 v = weighted_point(simplex);
    const double error = 20 * kUnit * largest_corner(simplex);
    return length_of(v.x, v.y, v.z) * (1 + 4 * kUnit) + error;
}

GjkResult gjk(const MovedHull& a, const MovedHull& b, const GjkGoal& goal, ConvexCache* cache,
              QueryCounts* counts) noexcept {
    Search search(a, b, goal);
    search.start(cache);
    const GjkVerdict verdict = search.run();
    const GjkResult result = search.result(verdict);
    if (cache != nullptr) search.remember(*cache);
    if (counts != nullptr) {
        ++counts->hull_pairs;
        counts->hull_steps += search.steps();
    }
    return result;
}

}  // namespace cdprep
