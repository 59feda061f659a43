// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_penetration.h"

#include "cdprep/format/float_environment.h"
#include "core/valid_errors.h"
#include "hull/exact_nearest.h"
#include "hull/expanding_polytope.h"
#include "hull/gjk.h"
#include "hull/hull_nearest.h"

namespace cdprep {
namespace {

Penetration expanded(const TwoHulls& hulls, const Difference* corner, std::size_t count,
                     const DistanceOptions& options, QueryCounts* counts) {
    ExpandingPolytope polytope(hulls.a, hulls.b);
    const Penetration result = polytope.expand(corner, count, with_valid_errors(options));
    if (counts != nullptr) counts->hull_steps += polytope.steps();
    return result;
}

}  // namespace

Penetration hull_depth(const TwoHulls& hulls, const NearestSimplex& common,
                       const DistanceOptions& options, QueryCounts* counts) noexcept {
    return expanded(hulls, common.corner.data(), common.count, options, counts);
}

std::optional<Penetration> convex_penetration(const ConvexPoints& a, const ConvexPoints& b,
                                              const Placement& placement,
                                              const DistanceOptions& options, ConvexCache* cache,
                                              QueryCounts* counts) noexcept {
    const format::FloatEnvironment environment;
    if (a.count == 0 || b.count == 0) return std::nullopt;
    const TwoHulls hulls(a, b, placement);
    const GjkResult found = gjk(hulls.a, hulls.b, {.farther = 0}, cache, counts);
    if (found.verdict == GjkVerdict::apart) return std::nullopt;
    if (found.verdict == GjkVerdict::meet) {
        const NearestSimplex& simplex = found.simplex;
        return expanded(hulls, simplex.corner.data(), simplex.count, options, counts);
    }
    const ExactNearest exact =
        exact_nearest(hulls.a, hulls.b, found.simplex, ExactGoal::verdict, counts);
    if (!exact.meet) return std::nullopt;
    return expanded(hulls, exact.corner.data(), exact.count, options, counts);
}

}  // namespace cdprep
