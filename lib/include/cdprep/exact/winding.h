// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/exact/predicates.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// The contribution of one triangle to the winding number of a surface around a point.
struct WindingTerm {
    int crossings;    ///< 1: the ray comes from behind; -1: from the front; 0: none
    bool on_surface;  ///< the point lies on the triangle; `crossings` is then 0
};

}  // namespace cdprep

namespace cdprep::exact {

/// Returns the contribution of triangle `t` to the winding number around q. It counts the crossing
/// of `t` by the ray that starts at q and runs away from o. Exact. `o` must differ from q.
///
/// Over a balanced surface, the contributions add up to the winding number, whatever o is. `o` is
/// perturbed symbolically to o + (e, e^2, e^3) with e infinitely small. So no ray meets an edge or
/// a vertex. A triangle without area adds nothing. (Feito and Torres 1997, with another rule for
/// vertices.)
[[nodiscard]] CDPREP_API WindingTerm winding_term(const Double3& o, const Double3& q,
                                                  const Corners& t) noexcept;

/// Returns an `o` for winding_term() whose ray runs from q along +x: a point with smaller x, at
/// least `reach` away. `reach` must be positive, and should be about the model's size. With a much
/// smaller value, the filter decides few triangles. If q.x is near the lowest double, the result is
/// nearer to q, or equals it.
[[nodiscard]] CDPREP_API Double3 before_along_x(const Double3& q, double reach) noexcept;

}  // namespace cdprep::exact
