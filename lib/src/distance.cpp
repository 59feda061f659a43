// SPDX-License-Identifier: MIT
#include "cdprep/distance.h"

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "nearest_search.h"

namespace cdprep {

std::optional<Distance> distance(const Model& a, const Model& b, const Placement& placement,
                                 Workspace& workspace, const DistanceOptions& options,
                                 PairCache* cache) noexcept {
    const format::FloatEnvironment environment;
    require(a, b, options.body == Body::solid ? Ask::distance | Ask::solid : Ask::distance);
    return distance_by<TriangleTrees>(a, b, placement, workspace, options, cache);
}

bool is_within(const Model& a, const Model& b, const Placement& placement, double tolerance,
               Workspace& workspace, PairCache* cache) noexcept {
    const format::FloatEnvironment environment;
    require(a, b, Ask::within);
    if (!(tolerance >= 0)) return false;
    if (tolerance == 0) return any_contact(a, b, placement, workspace, {}, cache);
    return is_within_by<TriangleTrees>(a, b, placement, tolerance, workspace, cache);
}

}  // namespace cdprep
