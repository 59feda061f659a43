// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/exact/winding.h"

namespace cdprep {

/// Counts the crossing of the triangle with the ray that starts at q and runs
/// away from o, as an outward-wound surface counts it. Exact. The origin is
/// perturbed symbolically, o + (e, e^2, e^3) with e infinitely small, so that no
/// ray runs through an edge or a vertex: over a closed surface the terms add up
/// to the winding number whatever o is. Degenerate triangles add nothing.
/// `o` must differ from q. (Feito and Torres 1997, with the vertex rule replaced.)
[[nodiscard]] WindingTerm winding_term(const Double3& o, const Double3& q,
                                       const Corners& t) noexcept;

/// The origin of a ray that runs from q along +x: a point before q, as far away as the
/// model is large, `reach`: a step too small for the predicates' filter would make every
/// triangle slow. Differs from q unless that is at the end of all numbers.
[[nodiscard]] Double3 before_along_x(const Double3& q, double reach) noexcept;

/// Signed solid angle of the triangle seen from q, in [-2 pi, 2 pi], rounded;
/// positive when q is behind it (van Oosterom and Strackee 1983).
[[nodiscard]] double solid_angle(const Double3& q, const Corners& t) noexcept;

}  // namespace cdprep
