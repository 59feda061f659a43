// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::test {

using format::Double3;

/// Points whose hull is hard to compute, and facts about that hull.
struct HardPointSet {
    std::string id;  ///< number in the catalogue, C01 ... C09, and a description
    std::vector<Double3> points;
    int dimension = 3;
    std::optional<std::size_t> corners{};  ///< known by hand
    std::optional<std::size_t> faces{};    ///< maximal coplanar faces; likewise
};

/// Returns C01 to C09 of the catalogue; with `full` at the catalogue's number of points.
[[nodiscard]] std::vector<HardPointSet> hard_point_sets(bool full);

/// C02: all points of [0, n)^3 with whole coordinates.
[[nodiscard]] std::vector<Double3> lattice(int n);
/// C03: points with whole coordinates on faces and edges of a cube of side 2^20, and its corners.
[[nodiscard]] std::vector<Double3> crowded_faces(int count);
/// C05: (t, t^2, t^3) for t = 1 ... count.
[[nodiscard]] std::vector<Double3> moment_curve(int count);
/// Returns the facets of the hull of moment_curve(count), sorted.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> cyclic_facets(std::uint32_t count);
/// C06: the unit cube, and points at the distance `bump` above the middles of its faces.
[[nodiscard]] std::vector<Double3> cube_with_bumps(double bump);
/// C07: points in a plane at a height, up to an error in the last bit.
[[nodiscard]] std::vector<Double3> noisy_plane(int count, double height);
/// C08: 60 random points, on a coarse grid if the seed is odd.
[[nodiscard]] std::vector<Double3> mixed_points(std::uint32_t seed);
/// C09: random points in the ball of radius 1.
[[nodiscard]] std::vector<Double3> points_in_a_ball(std::size_t count);

[[nodiscard]] std::vector<Double3> shuffled(std::vector<Double3> points, std::uint32_t seed);

}  // namespace cdprep::test
