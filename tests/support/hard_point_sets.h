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

/// Points whose hull is hard to find, and what must be said of it.
struct HardPointSet {
    std::string id;  ///< of the catalogue: C01 ... C09, with what is special
    std::vector<Double3> points;
    int dimension = 3;
    std::optional<std::size_t> corners{};  ///< known by hand
    std::optional<std::size_t> faces{};    ///< maximal coplanar ones; likewise
};

/// The catalogue's C01 to C09; with `full` as many points as it has.
[[nodiscard]] std::vector<HardPointSet> hard_point_sets(bool full);

/// C02: all of [0, n)^3 with whole coordinates.
[[nodiscard]] std::vector<Double3> lattice(int n);
/// C03: whole coordinates on faces and edges of a cube of side 2^20, and its corners.
[[nodiscard]] std::vector<Double3> crowded_faces(int count);
/// C05: (t, t^2, t^3) for t = 1 ... count.
[[nodiscard]] std::vector<Double3> moment_curve(int count);
/// The facets of its hull, sorted.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> cyclic_facets(std::uint32_t count);
/// C06: the unit cube, and points so far above the middles of its faces.
[[nodiscard]] std::vector<Double3> cube_with_bumps(double bump);
/// C07: a plane at some height, but for the last bit.
[[nodiscard]] std::vector<Double3> noisy_plane(int count, double height);
/// C08: 60 points; of a coarse grid where the seed is odd.
[[nodiscard]] std::vector<Double3> mixed_points(std::uint32_t seed);
/// C09: of the ball of radius 1.
[[nodiscard]] std::vector<Double3> points_in_a_ball(std::size_t count);

[[nodiscard]] std::vector<Double3> shuffled(std::vector<Double3> points, std::uint32_t seed);

}  // namespace cdprep::test
