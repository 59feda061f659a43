// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>

#include "decompose/enclose/solid.h"
#include "hull/convex_hull.h"

namespace cdprep::convex {

/// The distance by which a hull sticks out of a solid.
struct HullError {
    double lower = 0;  ///< `worst` is this far from the solid, up to rounding
    double upper = 0;  ///< proved: no point of the hull is farther from it
    Double3 worst = {0, 0, 0};
    std::size_t cells = 0;  ///< examined; some near very many triangles count as several
    std::size_t tests = 0;  ///< additional tests, of triangles against the hull's planes
};

struct HullErrorOptions {
    double relative = 0.02;  ///< upper - lower is at most this share of upper
    double enough = 0;       ///< or upper is at most this, model units; or 1e-6 of the diagonal
    /// Ends as soon as lower exceeds this.
    double too_much = std::numeric_limits<double>::infinity();
    std::size_t most_cells = 200'000;  ///< ends at this number, with the bounds found so far
};

/// Bounds the greatest distance of a point of the hull from the solid; points inside count as 0.
/// The whole hull counts, not its surface alone: a hull that closes off a cavity is detected.
///
/// Facets are halved, the one with the greatest bound first. The distance to one triangle is
/// convex, so the corners of a half bound it. Also, no point of a half is farther away than its
/// middle by more than the half's radius. Then cubes within the hull are cut, for points deeper
/// than 2 % of the error under the surface. Hulls that lie on the surface and in the solid, up to
/// rounding, are recognised at once.
///
/// Lengths must be of usual size, as SearchScale brings them.
[[nodiscard]] HullError find_hull_error(const ConvexHull& hull, const Solid& solid,
                                        const HullErrorOptions& options = {});

/// The same for the solid of a mesh. Lengths may have any size.
[[nodiscard]] HullError find_hull_error(const ConvexHull& hull, const mesh::Mesh& mesh,
                                        Reference reference, ParallelFor parallel_for);

}  // namespace cdprep::convex
