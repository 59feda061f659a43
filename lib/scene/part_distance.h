// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/hulls.h"
#include "cdprep/pairs.h"

namespace cdprep {

// A query about solids through their enclosing parts. It asks all pairs of parts, and ends early
// where it can. Both models have parts, which enclosing_parts() returned.
//
// Let the parts be d apart. They contain the solids, so these are at least d apart. A point of a
// part is at most its error from its solid. So the solids are at most d plus both errors apart.
// Poses move parts and vertices, each with roundings of its own: see rounding_of() in
// part_distance.cpp.
//
// Microseconds a query, in all of three poses: solids that touch, are near, and are farther apart
// than max_distance. Toruses of 1,024 and 14,400 triangles, with the pairs of their parts:
//
//     pairs     1         3           4           9           walk
//     1,024     6.7       9.7         10.8        23.6        18.5
//     14,400    11.8      13.9        14.4        31.1        28.7
//
// So the bound for cheaper parts is between 4 and 9 pairs: kMostPartPairs. Whether parts touch
// takes 3.8 and 5.7 with one pair. The exact collide() takes 4.2 and 4.9. So parts answer `collide`
// only where the distance tells.

/// Returns bounds of the distance of two solids, or nothing if it exceeds `max_distance`. Witnesses
/// are the nearest points of the nearest parts; triangles are kNoTriangleNumber. `lower` is 0 if
/// parts touch, up to rounding.
[[nodiscard]] std::optional<Distance> distance_of_parts(const Pair& pair, const EnclosingParts& a,
                                                        const EnclosingParts& b,
                                                        double max_distance) noexcept;

}  // namespace cdprep
