// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "query/distance_of_pieces.h"
#include "query/nearest_search.h"

namespace cdprep {

bool within(const Pair& pair, double tolerance, Workspace& workspace) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::within | ask_of(pair.options.through));
    if (!(tolerance >= 0) || a.triangle_count() == 0 || b.triangle_count() == 0) return false;
    if (pair.options.through == Structure::pieces) {
        return pieces_are_within(pair, tolerance, workspace);
    }
    if (tolerance == 0) return any_contact(a, b, pair.placement, workspace, {}, pair.cache);
    return is_within_by<TriangleTrees>(a, b, pair.placement, tolerance, workspace, pair.cache);
}

}  // namespace cdprep
