// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_distance.h"

#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "core/valid_errors.h"
#include "hull/exact_nearest.h"
#include "hull/gjk.h"
#include "hull/hull_nearest.h"

namespace cdprep {
namespace {

/// Returns whether the bounds are as close to each other as promised.
bool is_good(const GjkResult& found, const DistanceOptions& options) {
    const double width = found.upper - found.lower;
    if (width <= options.relative_error * found.upper || width <= options.absolute_error) {
        return true;
    }
    if (options.relative_error > 0 || options.absolute_error > 0) return false;
    double most = 0;
    for (std::size_t i = 0; i < found.simplex.count; ++i) {
        most = std::max(most, largest_of(found.simplex.corner[i].at));
    }
    return is_near_enough(found.lower, found.upper, most);
}

}  // namespace

std::optional<HullNearest> hull_nearest(const MovedHull& a, const MovedHull& b,
                                        const DistanceOptions& options, ConvexCache* cache,
                                        QueryCounts* counts) noexcept {
    const GjkGoal goal = {options.relative_error, options.absolute_error, options.max_distance};
    const GjkResult found = gjk(a, b, goal, cache, counts);
    if (found.lower > options.max_distance) return std::nullopt;
    if (found.verdict == GjkVerdict::meet) return HullNearest{true, {0, 0}, found.simplex};
    if (found.verdict == GjkVerdict::apart && is_good(found, options)) {
        return HullNearest{false, {found.lower, found.upper}, found.simplex};
    }
    const ExactNearest exact = exact_nearest(a, b, found.simplex, ExactGoal::nearest, counts);
    const NearestSimplex simplex = exactly_weighted(exact.corner.data(), exact.count);
    if (exact.meet) return HullNearest{true, {0, 0}, simplex};
    const DistanceBounds bounds = bounds_of(exact);
    if (bounds.lower > options.max_distance) return std::nullopt;
    return HullNearest{false, bounds, simplex};
}

bool convex_collide(const ConvexPoints& a, const ConvexPoints& b, const Placement& placement,
                    ConvexCache* cache, QueryCounts* counts) noexcept {
    const format::FloatEnvironment environment;
    if (a.count == 0 || b.count == 0) return false;
    const TwoHulls hulls(a, b, placement);
    const GjkResult found = gjk(hulls.a, hulls.b, {.farther = 0}, cache, counts);
    if (found.verdict != GjkVerdict::unsure) return found.verdict == GjkVerdict::meet;
    return exact_nearest(hulls.a, hulls.b, found.simplex, ExactGoal::verdict, counts).meet;
}

std::optional<ConvexDistance> convex_distance(const ConvexPoints& a, const ConvexPoints& b,
                                              const Placement& placement,
                                              const DistanceOptions& options, ConvexCache* cache,
                                              QueryCounts* counts) noexcept {
    const format::FloatEnvironment environment;
    if (a.count == 0 || b.count == 0 || !(options.max_distance >= 0)) return std::nullopt;
    const TwoHulls hulls(a, b, placement);
    const std::optional<HullNearest> found =
        hull_nearest(hulls.a, hulls.b, with_valid_errors(options), cache, counts);
    if (!found) return std::nullopt;
    const Double3 on_a = weighted_sum(found->simplex, &Difference::at_a);
    if (found->meet) return ConvexDistance{0, 0, on_a, on_a};
    return ConvexDistance{found->bounds.lower, found->bounds.upper, on_a,
                          weighted_sum(found->simplex, &Difference::at_b)};
}

bool convex_within(const ConvexPoints& a, const ConvexPoints& b, const Placement& placement,
                   double tolerance, ConvexCache* cache, QueryCounts* counts) noexcept {
    const format::FloatEnvironment environment;
    if (tolerance == 0) return convex_collide(a, b, placement, cache, counts);
    if (!(tolerance > 0) || a.count == 0 || b.count == 0) return false;
    if (!(tolerance <= std::numeric_limits<double>::max())) return true;
    const TwoHulls hulls(a, b, placement);
    const GjkGoal goal = {.farther = tolerance, .nearer = tolerance};
    const GjkResult found = gjk(hulls.a, hulls.b, goal, cache, counts);
    if (found.verdict == GjkVerdict::meet || found.upper <= tolerance) return true;
    if (found.verdict == GjkVerdict::apart && found.lower > tolerance) return false;
    const ExactNearest exact =
        exact_nearest(hulls.a, hulls.b, found.simplex, ExactGoal::nearest, counts);
    return exact.meet || is_within(exact, tolerance);
}

}  // namespace cdprep
