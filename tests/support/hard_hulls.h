// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "support/exact_hull_pair.h"
#include "support/hull_pairs.h"

namespace cdprep::test {

/// Two sets of points whose hulls are hard to tell apart, or to measure.
struct HardHulls {
    std::string id;  ///< of the catalogue: G01 ... G14, with what is special
    Points a;
    Points b;
    Placement placement = Placement::b_moves(Pose());
    std::optional<double> gap{};    ///< that they are apart, exactly, where known by hand
    std::optional<double> depth{};  ///< likewise, of those that meet
    /// Too many points for the definition: what is not known by hand is to be proved by
    /// directions that separate, or by points in common.
    bool is_large = false;
    bool is_integral = false;  ///< small integers, as placed
};

/// The catalogue's G01 to G14; with `full` more poses and points.
[[nodiscard]] std::vector<HardHulls> hard_hulls(bool full);

/// G01: two boxes in the poses of two reports against a widely used library, where its search
/// for the depth denied a contact that its search for the distance had found.
[[nodiscard]] std::vector<HardHulls> kissing_boxes();
/// G02: the pose of a report where a face of no area ended the search for the depth.
[[nodiscard]] HardHulls plate_and_tilted_box();
/// G04: its faces are squares, hexagons and rectangles.
[[nodiscard]] Points polytope_of_24_corners();
/// G05: `count` points with normal coordinates.
[[nodiscard]] Points normal_points(std::mt19937& random, std::size_t count);
/// G06: over a regular polygon of n corners, from z = 0 to 1; no coordinate needs more than 30
/// bits.
[[nodiscard]] Points prism(int n);
/// G10, G13: the lattice points at this distance from the origin, scaled.
[[nodiscard]] Points lattice_ball(int radius, double scale);
/// G14: support points that all but lie in one plane, at heights of 0 and a step, below others
/// so.
[[nodiscard]] HardHulls nearly_flat_hulls(std::mt19937& random);

/// How two hulls stand. Squares of lengths, without rounding.
struct HullTruth {
    std::optional<SquaredLength<ExactNumber>> distance{};  ///< nothing: they have a common point
    std::optional<SquaredLength<ExactNumber>> depth{};     ///< of those; nothing: not known
};

/// As known by hand, or by the definition. Not of large ones about which nothing is known.
[[nodiscard]] HullTruth hull_truth(const HardHulls& hard);

/// What a direction proves about the distance, without rounding; nothing when it does not
/// separate the hulls.
[[nodiscard]] std::optional<SquaredLength<ExactNumber>> proof_by(const Double3& direction,
                                                                 const Points& a, const Points& b);

}  // namespace cdprep::test
