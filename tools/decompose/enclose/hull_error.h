// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>

#include "hull/convex_hull.h"
#include "decompose/enclose/solid.h"

namespace cdprep::convex {

/// How far a hull sticks out of a solid.
struct HullError {
    double lower = 0;  ///< `worst` is that far from the solid, up to rounding
    double upper = 0;  ///< proved: no point of the hull is farther from it
    Double3 worst = {0, 0, 0};
    std::size_t cells = 0;  ///< looked at; those about as near to very many triangles several times
    std::size_t tests = 0;  ///< of triangles against the hull's planes, besides
};

struct HullErrorOptions {
    double relative = 0.02;  ///< upper - lower is at most that of upper
    double enough = 0;       ///< or upper is at most this, model units; or 1e-6 of the diagonal
    /// Ends as soon as lower is more than this.
    double too_much = std::numeric_limits<double>::infinity();
    /// Looks at the hull's surface alone: `upper` is then proved of that alone.
    bool surface_alone = false;
    std::size_t most_cells = 200'000;  ///< ends there with the bounds that it has
};

/// Bounds the greatest distance of a point of the hull from the solid: 0 inside. The
/// whole hull counts, not its surface alone: a hull that closes a cavity off is told.
///
/// Facets are halved, the one with the greatest bound first. The distance to one triangle
/// is convex, so that the corners of a part bound it; and no point of a part is farther
/// away than its middle by more than the part's radius. Then cubes within the hull are cut,
/// for what lies deeper than 2 % of the error under the surface. Hulls that lie on the
/// surface and in the solid, but for rounding, are told at once.
[[nodiscard]] HullError find_hull_error(const ConvexHull& hull, const Solid& solid,
                                        const HullErrorOptions& options = {});

}  // namespace cdprep::convex
