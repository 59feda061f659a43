// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "core/valid_errors.h"
#include "query/distance_of_pieces.h"
#include "query/nearest_search.h"

namespace cdprep {

std::optional<Distance> distance(const Pair& pair, Workspace& workspace,
                                 const DistanceOptions& options) noexcept {
    const format::FloatEnvironment environment;
    const Ask body = pair.options.body == Body::solid ? Ask::solid : Ask::nothing;
    require(pair.a, pair.b, Ask::distance | body | ask_of(pair.options.through));
    const DistanceOptions valid = with_valid_errors(options);
    if (pair.options.through == Structure::pieces) {
        return distance_of_pieces(pair, workspace, valid);
    }
    return distance_by<TriangleTrees>(pair, workspace, valid);
}

}  // namespace cdprep
