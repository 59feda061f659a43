// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::test {

using format::Double3;
using format::Triangle;

/// A mesh by shared vertices.
struct TestMesh {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
};

/// [0, 1]^3, closed, outward: 8 vertices, 12 triangles.
[[nodiscard]] TestMesh unit_cube();
/// An n x m sheet of unit squares in the plane z = 0, two triangles each.
[[nodiscard]] TestMesh grid_sheet(int n, int m);
/// The icosahedron with every triangle split into four `level` times, on the
/// unit sphere: 20 * 4^level triangles.
[[nodiscard]] TestMesh icosphere(int level);
/// About the z axis, centre line of radius `big`, tube of radius `small`.
[[nodiscard]] TestMesh torus(double big, double small, int n, int m);
/// The closed surface that has no inside, about the z axis, which passes through itself along
/// a circle: `rows` rings of `columns` corners, 3 or more of an odd number.
[[nodiscard]] TestMesh klein_bottle(int rows, int columns);
/// The triangles of a mesh that have no corner below z = 0.
[[nodiscard]] TestMesh upper_half(TestMesh mesh);
/// Three squares, of two triangles each, with an edge in common.
[[nodiscard]] TestMesh three_sheets();
/// Unconnected triangles with corners in [-1, 1]^3 within `size` of each other.
[[nodiscard]] TestMesh random_soup(std::uint32_t seed, int count, double size);
/// Unconnected triangles with corners on the integer grid [-grid, grid]^3, where
/// coincidences and degenerate triangles are common.
[[nodiscard]] TestMesh coarse_grid_soup(std::uint32_t seed, int count, int grid);
/// `count` triangles around the origin in the plane z = 0.
[[nodiscard]] TestMesh fan(int count);
/// The same triangle `count` times, each with vertices of its own.
[[nodiscard]] TestMesh copies_of_one_triangle(int count);
/// Tiny triangles at x = 2^-i for i < count.
[[nodiscard]] TestMesh geometric_progression(int count);

/// The points of the integer lattice at this distance from the origin.
[[nodiscard]] std::vector<Double3> lattice_sphere(int radius);

/// Both meshes in one, the second's numbers following the first's.
[[nodiscard]] TestMesh joined(const TestMesh& first, const TestMesh& second);
/// Every vertex at scale * p + shift, rounded once per operation.
[[nodiscard]] TestMesh moved_by(TestMesh mesh, double scale, const Double3& shift);
/// By an angle about the z axis and then about the x axis: no edge of a box stays along an axis.
[[nodiscard]] TestMesh turned(TestMesh mesh, double angle);
/// Every triangle with its winding reversed.
[[nodiscard]] TestMesh reversed(TestMesh mesh);
/// Coordinates rounded to floats, so that single precision loses nothing.
[[nodiscard]] TestMesh in_floats(TestMesh mesh);

}  // namespace cdprep::test
