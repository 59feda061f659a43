// SPDX-License-Identifier: MIT
#include "mesh/half_edges.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

// By hand: a cube of 12 triangles has 18 edges, each used twice.
TEST(HalfEdges, ACubeUsesEachEdgeTwice) {
    const Mesh cube = test::mesh_of(test::unit_cube());
    const EdgeUses edges = find_edge_uses(cube.triangles, cube.positions.size());
    ASSERT_EQ(edges.edge_count(), 18U);
    for (std::size_t edge = 0; edge < 18; ++edge) EXPECT_EQ(edges.of(edge).size(), 2U);
}

// More triangles than memory holds: they are refused by their number, and none is read.
TEST(HalfEdges, AMeshWithoutNumbersForItsHalfEdgesIsRefused) {
    const Triangle one{};
    const std::span<const Triangle> more(&one, std::size_t{kMostMeshTriangles} + 1);
    EXPECT_THROW((void)find_edge_uses(more, 3), std::length_error);
}

}  // namespace
}  // namespace cdprep::mesh
