// SPDX-License-Identifier: MIT
#include "mesh/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "mesh/weld.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

Topology topology_of(const test::TestMesh& mesh) {
    return find_topology(test::mesh_of(mesh));
}

bool is_balanced(const format::Component& component) {
    return (component.flags & format::component_balanced) != 0;
}

TEST(Topology, ACubeIsOneBalancedComponentOfVolumeOne) {
    const Topology topology = topology_of(test::unit_cube());
    EXPECT_TRUE(topology.balanced);
    ASSERT_EQ(topology.components.size(), 1U);
    EXPECT_TRUE(is_balanced(topology.components[0]));
    EXPECT_EQ(topology.components[0].triangle_count, 12U);
    EXPECT_EQ(topology.components[0].signed_volume, 1.0);
    EXPECT_EQ(topology.components[0].reserved, 0U);
}

TEST(Topology, AnInvertedCubeHasNegativeVolume) {
    const Topology topology = topology_of(test::reversed(test::unit_cube()));
    EXPECT_TRUE(topology.balanced);
    EXPECT_EQ(topology.components[0].signed_volume, -1.0);
}

TEST(Topology, ASheetIsUnbalancedAndHasNoVolume) {
    const Topology topology = topology_of(test::grid_sheet(3, 2));
    EXPECT_FALSE(topology.balanced);
    ASSERT_EQ(topology.components.size(), 1U);
    EXPECT_FALSE(is_balanced(topology.components[0]));
    EXPECT_EQ(topology.components[0].signed_volume, 0.0);
}

TEST(Topology, OneTriangleLessUnbalancesOnlyItsComponent) {
    test::TestMesh mesh =
        test::joined(test::unit_cube(), test::moved_by(test::unit_cube(), 2, {10, 0, 0}));
    mesh.triangles.erase(mesh.triangles.begin());
    const Topology topology = topology_of(mesh);
    EXPECT_FALSE(topology.balanced);
    ASSERT_EQ(topology.components.size(), 2U);
    EXPECT_FALSE(is_balanced(topology.components[0]));
    EXPECT_EQ(topology.components[0].triangle_count, 11U);
    EXPECT_TRUE(is_balanced(topology.components[1]));
    EXPECT_EQ(topology.components[1].signed_volume, 8.0);
}

TEST(Topology, OneTurnedTriangleUnbalancesTheCube) {
    test::TestMesh mesh = test::unit_cube();
    std::swap(mesh.triangles[5].vertex[0], mesh.triangles[5].vertex[1]);
    EXPECT_FALSE(topology_of(mesh).balanced);
}

// The uses cancel, four at the shared edge: winding numbers are defined.
TEST(Topology, CubesThatShareAnEdgeAreOneBalancedComponent) {
    const Welded welded = weld(test::soup_of(
        test::joined(test::unit_cube(), test::moved_by(test::unit_cube(), 1, {1, 1, 0}))));
    const Topology topology = find_topology(welded.mesh);
    EXPECT_TRUE(topology.balanced);
    ASSERT_EQ(topology.components.size(), 1U);
    EXPECT_EQ(topology.components[0].signed_volume, 2.0);
}

TEST(Topology, CubesThatShareOneVertexAreOneComponent) {
    const Welded welded = weld(test::soup_of(
        test::joined(test::unit_cube(), test::moved_by(test::unit_cube(), 1, {1, 1, 1}))));
    EXPECT_EQ(find_topology(welded.mesh).components.size(), 1U);
}

TEST(Topology, ComponentsStandInTheOrderOfTheirLowestTriangle) {
    test::TestMesh mesh =
        test::joined(test::moved_by(test::unit_cube(), 1, {50, 0, 0}), test::grid_sheet(1, 1));
    // The sheet's first triangle to the front: now its component comes first.
    std::swap(mesh.triangles[0], mesh.triangles[12]);
    const Topology topology = topology_of(mesh);
    ASSERT_EQ(topology.components.size(), 2U);
    EXPECT_EQ(topology.components[0].triangle_count, 2U);
    EXPECT_EQ(topology.components[1].triangle_count, 12U);
    EXPECT_GE(topology.components[0].vertex, 8U);
    EXPECT_LT(topology.components[1].vertex, 8U);
}

TEST(Topology, CornersThatRepeatAddNothing) {
    test::TestMesh mesh = test::unit_cube();
    mesh.triangles.push_back({{0, 0, 0}});
    mesh.triangles.push_back({{1, 1, 2}});
    const Topology topology = topology_of(mesh);
    EXPECT_TRUE(topology.balanced);
    EXPECT_EQ(topology.components[0].triangle_count, 14U);
    EXPECT_EQ(topology.components[0].signed_volume, 1.0);
}

TEST(Topology, AMeshWithoutTrianglesIsBalanced) {
    const Topology topology = find_topology({});
    EXPECT_TRUE(topology.balanced);
    EXPECT_TRUE(topology.components.empty());
}

TEST(Topology, VolumesBeyondTheLargestDoubleAreCutToIt) {
    const Topology topology =
        topology_of(test::moved_by(test::unit_cube(), std::ldexp(1.0, 900), {0, 0, 0}));
    EXPECT_TRUE(topology.balanced);
    EXPECT_TRUE(std::isfinite(topology.components[0].signed_volume));
}

/// Components by spreading from triangle to triangle over shared vertices.
std::vector<std::set<std::size_t>> components_by_spreading(const test::TestMesh& mesh) {
    std::vector<std::set<std::size_t>> components;
    std::vector<bool> seen(mesh.triangles.size(), false);
    for (std::size_t start = 0; start < mesh.triangles.size(); ++start) {
        if (seen[start]) continue;
        std::set<std::size_t> component;
        std::vector<std::size_t> front = {start};
        while (!front.empty()) {
            const std::size_t at = front.back();
            front.pop_back();
            if (seen[at]) continue;
            seen[at] = true;
            component.insert(at);
            for (std::size_t other = 0; other < mesh.triangles.size(); ++other) {
                for (const std::uint32_t v : mesh.triangles[at].vertex) {
                    for (const std::uint32_t w : mesh.triangles[other].vertex) {
                        if (v == w) front.push_back(other);
                    }
                }
            }
        }
        components.push_back(component);
    }
    return components;
}

bool edges_cancel(const test::TestMesh& mesh, const std::set<std::size_t>& component) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const std::size_t i : component) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = mesh.triangles[i].vertex[k];
            const std::uint32_t to = mesh.triangles[i].vertex[(k + 1) % 3];
            if (from != to) balance[std::minmax(from, to)] += from < to ? 1 : -1;
        }
    }
    for (const auto& [edge, sum] : balance) {
        if (sum != 0) return false;
    }
    return true;
}

// Few vertices, many triangles: edges with many uses, components that balance by
// chance.
TEST(TopologyLaws, RandomMeshesAgreeWithSpreadingAndCounting) {
    int balanced = 0, others = 0;
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        std::mt19937 random(seed);
        test::TestMesh mesh;
        const std::uint32_t vertices = 4 + seed % 30;
        mesh.positions = test::random_soup(seed, static_cast<int>(vertices), 1).positions;
        mesh.positions.resize(vertices);
        std::uniform_int_distribution<std::uint32_t> any(0, vertices - 1);
        for (std::uint32_t i = 0; i < 1 + seed % 9; ++i) {
            const Triangle triangle{{any(random), any(random), any(random)}};
            mesh.triangles.push_back(triangle);
            if (random() % 2 == 0) continue;  // with its back, so that some balance
            mesh.triangles.push_back(
                {{triangle.vertex[0], triangle.vertex[2], triangle.vertex[1]}});
        }
        const Topology topology = topology_of(mesh);
        const auto expected = components_by_spreading(mesh);
        ASSERT_EQ(topology.components.size(), expected.size()) << "seed " << seed;
        bool all_balanced = true;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const format::Component& found = topology.components[i];
            EXPECT_EQ(found.triangle_count, expected[i].size()) << "seed " << seed;
            EXPECT_EQ(is_balanced(found), edges_cancel(mesh, expected[i])) << "seed " << seed;
            const auto& vertex = mesh.triangles[*expected[i].begin()].vertex;
            EXPECT_NE(std::find(vertex.begin(), vertex.end(), found.vertex), vertex.end());
            (is_balanced(found) ? balanced : others) += 1;
            all_balanced = all_balanced && is_balanced(found);
        }
        EXPECT_EQ(topology.balanced, all_balanced) << "seed " << seed;
    }
    EXPECT_GT(balanced, (balanced + others) / 5);
    EXPECT_GT(others, (balanced + others) / 5);
}

}  // namespace
}  // namespace cdprep::mesh
