// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "decompose/enclose/solid.h"
#include "hull/convex_hull.h"

namespace cdprep::convex {

/// Bounds the distance of a hull's points from the solid. The solid's surface must enter the hull
/// nowhere deeper than `deepest`. All of the hull except a skin then lies in the solid. This suits
/// convex parts of a solid, whose facets lie on its surface. Returns nothing if the surface goes
/// deeper, or the hull lies outside or has no volume. Also returns nothing if some millions of
/// tests do not decide. Model units; proved, rounding included.
[[nodiscard]] std::optional<double> bound_flush(const ConvexHull& hull, const Solid& solid,
                                                double deepest);

}  // namespace cdprep::convex
