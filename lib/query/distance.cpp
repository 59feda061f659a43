// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "query/distance_of_pieces.h"
#include "query/nearest_search.h"

namespace cdprep {

std::optional<Distance> distance(const Pair& pair, Workspace& workspace,
                                 const DistanceOptions& options) noexcept {
    const format::FloatEnvironment environment;
    const Ask body = pair.options.body == Body::solid ? Ask::solid : Ask::nothing;
    require(pair.a, pair.b, Ask::distance | body | ask_of(pair.options.through));
    if (pair.options.through == Structure::pieces) {
        return distance_of_pieces(pair, workspace, options);
    }
    return distance_by<TriangleTrees>(pair, workspace, options);
}

}  // namespace cdprep
