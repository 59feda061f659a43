// SPDX-License-Identifier: MIT
#include "decompose/enclose/mesh_nodes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mesh/weld.h"
#include "support/meshes.h"
#include "unit/tools/soup_of.h"

namespace cdprep::cli {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// A cube and an open box, each with as many triangles as its name says.
mesh::TriangleSoup cube_and_box() {
    test::TestMesh box = test::moved_by(test::unit_cube(), 1, {3, 0, 0});
    box.triangles.resize(8);
    return test::soup_of(test::joined(test::unit_cube(), box));
}

MeshNodes nodes_of(const mesh::TriangleSoup& soup) {
    return find_nodes(soup, mesh::weld(soup).mesh);
}

/// How many triangles in a row are of which node.
std::vector<std::pair<std::uint32_t, int>> runs_of(const Numbers& numbers) {
    std::vector<std::pair<std::uint32_t, int>> runs;
    for (const std::uint32_t number : numbers) {
        if (runs.empty() || runs.back().first != number) runs.emplace_back(number, 0);
        ++runs.back().second;
    }
    return runs;
}

mesh::TriangleSoup with_instances(const std::string& first, const std::string& second) {
    mesh::TriangleSoup soup = cube_and_box();
    soup.instance_names = {second, first};
    soup.instances = {{{}, 0, 1, 0, 12, 0, 0}, {{}, 0, 0, 12, 8, 0, 0}};
    return soup;
}

mesh::TriangleSoup with_groups(const std::string& first, const std::string& second) {
    mesh::TriangleSoup soup = cube_and_box();
    soup.groups.names = {first, second};
    soup.groups.runs = {{0, 12, 0, 0}, {12, 8, 1, 0}};
    return soup;
}

TEST(FindNodes, AMeshWithoutNodesOrGroupsIsOne) {
    const MeshNodes nodes = nodes_of(cube_and_box());
    EXPECT_TRUE(nodes.node_of.empty());
    EXPECT_TRUE(nodes.names.empty());
}

// Of a file with nodes each one is a body of its own, closed or not.
TEST(FindNodes, NodesStayApartWhetherTheyAreClosedOrNot) {
    const MeshNodes nodes = nodes_of(with_instances("root/a", "root/b"));
    EXPECT_EQ(runs_of(nodes.node_of),
              (std::vector<std::pair<std::uint32_t, int>>{{0, 12}, {1, 8}}));
    EXPECT_EQ(nodes.names, (std::vector<std::string>{"root/a", "root/b"}));
    EXPECT_EQ(nodes.is_convex, (std::vector<std::uint8_t>{0, 0}));
}

// An open group is a part of a surface: it belongs to the triangles without a name.
TEST(FindNodes, GroupsThatAreOpenAreOfNoNode) {
    const MeshNodes nodes = nodes_of(with_groups("a", "b"));
    EXPECT_EQ(runs_of(nodes.node_of),
              (std::vector<std::pair<std::uint32_t, int>>{{0, 12}, {2, 8}}));
    EXPECT_EQ(nodes.names, (std::vector<std::string>{"a", "b", ""}));
    EXPECT_EQ(nodes.is_convex, (std::vector<std::uint8_t>{0, 0, 0}));
    mesh::TriangleSoup one = with_groups("a", "b");
    one.groups.names.pop_back();
    EXPECT_TRUE(nodes_of(one).node_of.empty());
}

TEST(FindNodes, NamesMarkConvexOnes) {
    const MeshNodes groups = nodes_of(with_groups("a-convex", "UCX_b"));
    EXPECT_EQ(runs_of(groups.node_of),
              (std::vector<std::pair<std::uint32_t, int>>{{0, 12}, {1, 8}}));
    EXPECT_EQ(groups.is_convex, (std::vector<std::uint8_t>{1, 1, 0}));
    for (const char* name : {"root/UCX_a", "x-convcol", "x-convcolonly", "root/x_convex"}) {
        EXPECT_EQ(nodes_of(with_instances(name, "x")).is_convex, (std::vector<std::uint8_t>{1, 0}))
            << name;
    }
    for (const char* name : {"UCX_root/a", "a-convex/b", "xUCX_", "convex", "-convex.001"}) {
        EXPECT_EQ(nodes_of(with_instances(name, "x")).is_convex, (std::vector<std::uint8_t>{0, 0}))
            << name;
    }
}

// Godot takes ...-colonly as it is: an open group of that name stays a node, and is no hull.
TEST(FindNodes, CollidersOfAnyShapeStayApart) {
    const MeshNodes groups = nodes_of(with_groups("a", "b-colonly"));
    EXPECT_EQ(runs_of(groups.node_of),
              (std::vector<std::pair<std::uint32_t, int>>{{0, 12}, {1, 8}}));
    EXPECT_EQ(groups.is_convex, (std::vector<std::uint8_t>{0, 0, 0}));
    EXPECT_EQ(nodes_of(with_instances("root/a-colonly", "b")).is_convex,
              (std::vector<std::uint8_t>{0, 0}));
    const MeshNodes below = nodes_of(with_groups("a", "colliders/b"));
    EXPECT_EQ(runs_of(below.node_of),
              (std::vector<std::pair<std::uint32_t, int>>{{0, 12}, {1, 8}}));
    EXPECT_EQ(below.is_convex, (std::vector<std::uint8_t>{0, 0, 0}));
    const MeshNodes others = nodes_of(with_groups("a", "b-colonly.001"));
    EXPECT_EQ(runs_of(others.node_of),
              (std::vector<std::pair<std::uint32_t, int>>{{0, 12}, {2, 8}}));
}

}  // namespace
}  // namespace cdprep::cli
