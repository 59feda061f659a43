// SPDX-License-Identifier: MIT
#include "repair/repaired_soup.h"

#include <gtest/gtest.h>

namespace cdprep::mesh {
namespace {

/// Two nodes of two triangles each, one group a triangle, faces of two triangles.
TriangleSoup two_nodes() {
    TriangleSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    soup.triangles = {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 2, 3}}, {{1, 2, 3}}};
    soup.face = {0, 0, 0, 0};
    soup.instances = {{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 0, 0, 0, 2, 0, 0},
                      {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 1, 1, 2, 2, 0, 0}};
    soup.instance_names = {"left", "right"};
    soup.groups = {{{0, 3, 0, 0}, {3, 1, 1, 0}}, {"most", "last"}};
    return soup;
}

/// Triangle 2 in two fragments, 0 dropped, one made.
RepairMesh cut_and_closed() {
    RepairMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0, 0}};
    mesh.vertex_origin = {{0, {}}, {1, {}}, {2, {}}, {3, {}}, {kNone, RepairStep::fill_holes}};
    mesh.triangles = {{{0, 1, 3}}, {{0, 2, 4}}, {{0, 1, 4}}, {{1, 2, 3}}, {{2, 3, 4}}};
    mesh.triangle_origin = {{1, {}},
                            {2, RepairStep::resolve_t_junctions},
                            {kNone, RepairStep::fill_holes},
                            {3, {}},
                            {2, RepairStep::resolve_t_junctions}};
    return mesh;
}

// By hand, from the two meshes above.
TEST(RepairedSoup, TrianglesStandInTheOrderOfTheirSources) {
    const RepairedSoup result = as_soup(two_nodes(), cut_and_closed());
    EXPECT_EQ(result.triangle_from, (std::vector<std::uint32_t>{1, 2, 2, 3, kNone}));
    EXPECT_EQ(result.vertex_from, (std::vector<std::uint32_t>{0, 1, 2, 3, kNone}));
    ASSERT_EQ(result.soup.triangles.size(), 5u);
    EXPECT_EQ(result.soup.triangles[1].vertex, (std::array<std::uint32_t, 3>{0, 2, 4}));
    EXPECT_EQ(result.soup.triangles[2].vertex, (std::array<std::uint32_t, 3>{2, 3, 4}));
    EXPECT_EQ(result.soup.face, (std::vector<std::uint32_t>{0, 0, 0, 0, 0}));
}

// By hand: all faces are triangles, so the sources 1, 2, 2, 3 are the faces 1 of the left node and
// 0, 0, 1 of the right one; the new triangle is the first face of its own node.
TEST(RepairedSoup, FacesThatTheImportDoesNotListCountWithinTheirNodes) {
    TriangleSoup soup = two_nodes();
    soup.face.clear();
    EXPECT_EQ(as_soup(soup, cut_and_closed()).soup.face,
              (std::vector<std::uint32_t>{1, 0, 0, 1, 0}));
    soup.instances.clear();  // then they count through the file
    EXPECT_EQ(as_soup(soup, cut_and_closed()).soup.face,
              (std::vector<std::uint32_t>{1, 2, 2, 3, 0}));
}

TEST(RepairedSoup, NodesAndGroupsKeepWhatIsLeftOfThem) {
    const RepairedSoup result = as_soup(two_nodes(), cut_and_closed());
    const std::vector<format::Instance>& nodes = result.soup.instances;
    ASSERT_EQ(nodes.size(), 3u);
    EXPECT_EQ(nodes[0].triangle_count, 1u);
    EXPECT_EQ(nodes[1].first_triangle, 1u);
    EXPECT_EQ(nodes[1].triangle_count, 3u);
    EXPECT_EQ(nodes[2].first_triangle, 4u);
    EXPECT_EQ(result.soup.instance_names[nodes[2].name], "repair");
    const std::vector<format::NamedRun>& groups = result.soup.groups.runs;
    ASSERT_EQ(groups.size(), 3u);
    EXPECT_EQ(groups[0].triangle_count, 3u);
    EXPECT_EQ(groups[1].triangle_count, 1u);
    EXPECT_EQ(groups[2].triangle_count, 1u);
    EXPECT_TRUE(result.soup.materials.runs.empty());
}

TEST(RepairedSoup, WithoutNewTrianglesThereIsNoRunOfThem) {
    RepairMesh mesh = cut_and_closed();
    mesh.triangles.erase(mesh.triangles.begin() + 2);
    mesh.triangle_origin.erase(mesh.triangle_origin.begin() + 2);
    const RepairedSoup result = as_soup(two_nodes(), mesh);
    EXPECT_EQ(result.soup.instances.size(), 2u);
    EXPECT_EQ(result.soup.instance_names.size(), 2u);
}

}  // namespace
}  // namespace cdprep::mesh
