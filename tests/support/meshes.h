// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::test {

using format::Double3;
using format::Triangle;

/// A mesh with shared vertices.
struct TestMesh {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
};

/// Returns the cube [0, 1]^3, closed, with outward normals: 8 vertices, 12 triangles.
[[nodiscard]] TestMesh unit_cube();
/// Returns one triangle with the corners (0, 0, 0), (4, 0, 0) and (0, 4, 0).
[[nodiscard]] TestMesh right_triangle();
/// Returns an n x m sheet of unit squares in the plane z = 0, two triangles each.
[[nodiscard]] TestMesh grid_sheet(int n, int m);
/// Returns the icosahedron with every triangle split into four `level` times, on the
/// unit sphere: 20 * 4^level triangles.
[[nodiscard]] TestMesh icosphere(int level);
/// Returns a torus about the z axis: centre line of radius `big`, tube of radius `small`.
[[nodiscard]] TestMesh torus(double big, double small, int n, int m);
/// Returns a Klein bottle about the z axis: a closed surface without an inside, which passes
/// through itself along a circle. It has `rows` rings of `columns` corners; `columns` must be odd
/// and at least 3.
[[nodiscard]] TestMesh klein_bottle(int rows, int columns);
/// Returns the triangles of a mesh that have no corner below z = 0.
[[nodiscard]] TestMesh upper_half(TestMesh mesh);
/// Returns three squares, of two triangles each, with a common edge.
[[nodiscard]] TestMesh three_sheets();
/// Returns unconnected triangles with corners in [-1, 1]^3 within `size` of each other.
[[nodiscard]] TestMesh random_soup(std::uint32_t seed, int count, double size);
/// Returns unconnected triangles with corners on the integer grid [-grid, grid]^3. Coincidences
/// and degenerate triangles are common.
[[nodiscard]] TestMesh coarse_grid_soup(std::uint32_t seed, int count, int grid);
/// Returns `count` triangles around the origin in the plane z = 0.
[[nodiscard]] TestMesh fan(int count);
/// Returns the same triangle `count` times, each with its own vertices.
[[nodiscard]] TestMesh copies_of_one_triangle(int count);
/// Returns tiny triangles at x = 2^-i for i < count.
[[nodiscard]] TestMesh geometric_progression(int count);

/// Returns the points of the integer lattice at the distance `radius` from the origin.
[[nodiscard]] std::vector<Double3> lattice_sphere(int radius);

/// Returns both meshes in one. The numbers of the second follow those of the first.
[[nodiscard]] TestMesh joined(const TestMesh& first, const TestMesh& second);
/// Returns the mesh with every vertex at scale * p + shift, rounded once per operation.
[[nodiscard]] TestMesh moved_by(TestMesh mesh, double scale, const Double3& shift);
/// Returns the mesh rotated by an angle about the z axis and then about the x axis. No edge of a
/// box stays parallel to an axis.
[[nodiscard]] TestMesh turned(TestMesh mesh, double angle);
/// Returns the mesh with one vertex for all corners at one place.
[[nodiscard]] TestMesh with_shared_vertices(TestMesh mesh);
/// Returns the mesh with the winding of every triangle reversed.
[[nodiscard]] TestMesh reversed(TestMesh mesh);
/// Returns the mesh with coordinates rounded to floats, so that single precision loses nothing.
[[nodiscard]] TestMesh in_floats(TestMesh mesh);
/// Returns the positions of a mesh, rounded to floats.
[[nodiscard]] inline std::vector<format::Float3> floats_of(const TestMesh& mesh) {
    std::vector<format::Float3> floats;
    for (const Double3& p : mesh.positions) {
        floats.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    return floats;
}

}  // namespace cdprep::test
