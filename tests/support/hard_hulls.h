// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "support/exact_hull_pair.h"
#include "support/hull_pairs.h"

namespace cdprep::test {

/// Two sets of points whose hulls are hard to separate, or hard to measure.
struct HardHulls {
    std::string id;  ///< number in the catalogue, G01 ... G14, and a description
    Points a;
    Points b;
    Placement placement = Placement::b_moves(Pose());
    std::optional<double> gap{};    ///< exact distance of disjoint hulls, if known by hand
    std::optional<double> depth{};  ///< likewise, the depth of hulls that meet
    /// There are too many points for the definition. Facts that are not known by hand must be
    /// proved by separating directions or by common points.
    bool is_large = false;
    bool is_integral = false;  ///< small integers, as placed
};

/// Returns G01 to G14 of the catalogue; with `full` more poses and points.
[[nodiscard]] std::vector<HardHulls> hard_hulls(bool full);

/// G01: two boxes in the poses of two bug reports about a widely used library. Its depth query
/// denied a contact that its distance query had found.
[[nodiscard]] std::vector<HardHulls> kissing_boxes();
/// G02: the pose of a bug report in which a face of zero area ended the search for the depth.
[[nodiscard]] HardHulls plate_and_tilted_box();
/// G04: a polytope with squares, hexagons and rectangles as faces.
[[nodiscard]] Points polytope_of_24_corners();
/// G05: `count` points with normal coordinates.
[[nodiscard]] Points normal_points(std::mt19937& random, std::size_t count);
/// G06: a prism over a regular polygon of n corners, from z = 0 to 1. No coordinate needs more
/// than 30 bits.
[[nodiscard]] Points prism(int n);
/// G10, G13: the lattice points at this distance from the origin, scaled.
[[nodiscard]] Points lattice_ball(int radius, double scale);
/// G14: points almost in one plane, at heights of 0 and a tiny step, below other such points.
[[nodiscard]] HardHulls nearly_flat_hulls(std::mt19937& random);

/// The distance or depth of two hulls. Squares of lengths, without rounding.
struct HullTruth {
    std::optional<SquaredLength<ExactNumber>> distance{};  ///< nothing: they have a common point
    std::optional<SquaredLength<ExactNumber>> depth{};     ///< then the depth; nothing: unknown
};

/// Returns the truth known by hand, or from the definition. Not for large hulls without known
/// facts.
[[nodiscard]] HullTruth hull_truth(const HardHulls& hard);

/// Returns the distance that a direction proves, squared and without rounding. Returns nothing if
/// the direction does not separate the hulls.
[[nodiscard]] std::optional<SquaredLength<ExactNumber>> proof_by(const Double3& direction,
                                                                 const Points& a, const Points& b);

}  // namespace cdprep::test
