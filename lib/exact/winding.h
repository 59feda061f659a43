// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/exact/winding.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// Counts the crossing of the triangle with the ray that starts at q and runs away from o. The sign
/// is that for an outward-wound surface. Exact. The origin is perturbed symbolically to
/// o + (e, e^2, e^3), e infinitely small, so no ray meets an edge or a vertex. Over a balanced
/// surface the terms add up to the winding number for any o. Degenerate triangles add nothing. `o`
/// must differ from q. (Feito and Torres 1997, with another rule for vertices.)
[[nodiscard]] CDPREP_API WindingTerm winding_term(const Double3& o, const Double3& q,
                                                  const Corners& t) noexcept;

/// Returns an `o` for winding_term() whose ray runs from q along +x: a point at least `reach`
/// before q. `reach` is about the model's size. With a much smaller step, the predicates' filter
/// would decide few triangles, and every triangle would be slow. Differs from q unless |q.x| is
/// near the largest double.
[[nodiscard]] CDPREP_API Double3 before_along_x(const Double3& q, double reach) noexcept;

/// Returns the signed solid angle of the triangle seen from q, in [-2 pi, 2 pi], rounded. Positive
/// when q is behind the triangle (van Oosterom and Strackee 1983).
[[nodiscard]] double solid_angle(const Double3& q, const Corners& t) noexcept;

}  // namespace cdprep
