// SPDX-License-Identifier: MIT
#include "repair/repair_steps.h"

#include <gtest/gtest.h>

#include "unit/tools/repair_mesh_of.h"

namespace cdprep::mesh {
namespace {

// An octahedron stands in the open side, so the patch is taken back. The last vertex, which no
// triangle uses, then goes too.
TEST(FillHoles, APatchThatIsTakenBackAddsNoVertices) {
    test::TestMesh mesh;
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            for (const double z : {-1.0, 1.0}) mesh.positions.push_back({x, y, z});
        }
    }
    mesh.triangles = {{{0, 1, 3}}, {{0, 3, 2}}, {{0, 4, 5}}, {{0, 5, 1}}, {{2, 3, 7}},
                      {{2, 7, 6}}, {{0, 2, 6}}, {{0, 6, 4}}, {{1, 5, 7}}, {{1, 7, 3}}};
    test::TestMesh octahedron;
    octahedron.positions = {{1.25, 0, 0},  {0.75, 0, 0}, {1, 0.25, 0},
                            {1, -0.25, 0}, {1, 0, 0.25}, {1, 0, -0.25}};
    octahedron.triangles = {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}},
                            {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}};
    mesh = test::joined(mesh, octahedron);
    mesh.positions.push_back({5, 5, 5});
    const Stepped done = fill_holes(test::repair_mesh_of(mesh), {100, Crossing::refused}, {});
    EXPECT_EQ(done.mesh.triangles, mesh.triangles);
    EXPECT_EQ(done.report.refused.size(), 1U);
    EXPECT_EQ(done.report.added_triangles, 0U);
    EXPECT_EQ(done.report.added_vertices, 0U);
    EXPECT_EQ(done.report.unused, std::vector<std::uint32_t>{14});
}

// The patch of a lone triangle has a vertex in its middle, and lies on it.
TEST(FillHoles, TheMiddleOfAPatchThatIsTakenBackGoesWithIt) {
    const test::TestMesh lone = test::right_triangle();
    const Stepped done = fill_holes(test::repair_mesh_of(lone), {100, Crossing::refused}, {});
    EXPECT_EQ(done.mesh.triangles, lone.triangles);
    EXPECT_EQ(done.mesh.positions, lone.positions);
    EXPECT_EQ(done.report.refused.size(), 1U);
    EXPECT_EQ(done.report.added_triangles, 0U);
    EXPECT_EQ(done.report.added_vertices, 0U);
}

}  // namespace
}  // namespace cdprep::mesh
