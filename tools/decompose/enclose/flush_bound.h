// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "hull/convex_hull.h"
#include "decompose/enclose/solid.h"

namespace cdprep::convex {

/// Bounds the distance of any point of a hull from the solid, where the solid's surface goes
/// nowhere deeper into the hull than `deepest`: all but a skin of the hull then lies in the
/// solid. As for parts of a solid that are convex, whose facets lie on its surface. Nothing
/// where it goes deeper, where the hull lies outside or has no volume, and where as much
/// cannot be told with some millions of tests. Model units; proved, rounding included.
[[nodiscard]] std::optional<double> bound_flush(const ConvexHull& hull, const Solid& solid,
                                                double deepest);

}  // namespace cdprep::convex
