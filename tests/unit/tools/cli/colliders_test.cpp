// SPDX-License-Identifier: MIT
#include "cli/colliders.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/meshes.h"
#include "unit/tools/soup_of.h"

namespace cdprep::cli {
namespace {

using mesh::TriangleSoup;
using Names = std::vector<std::string>;

/// Three cubes of 12 triangles and 8 vertices each, one after the other.
TriangleSoup cubes() {
    const test::TestMesh second = test::moved_by(test::unit_cube(), 1, {3, 0, 0});
    const test::TestMesh third = test::moved_by(test::unit_cube(), 1, {0.1, 0, 0});
    return test::soup_of(test::joined(test::joined(test::unit_cube(), second), third));
}

TriangleSoup with_instances(const Names& names) {
    TriangleSoup soup = cubes();
    soup.instance_names = names;
    soup.instances = {{{}, 7, 0, 0, 12, 0, 0}, {{}, 8, 1, 12, 12, 0, 0}, {{}, 9, 2, 24, 12, 0, 0}};
    return soup;
}

TriangleSoup with_groups(const Names& names) {
    TriangleSoup soup = cubes();
    soup.groups = {{{0, 12, 0, 0}, {12, 12, 1, 0}, {24, 12, 2, 0}}, names};
    return soup;
}

TEST(IsCollider, KnowsTheNamesOfEngines) {
    for (const char* path :
         {"UCX_a_00", "root/UBX_a", "USP_", "UCP_a", "a-colonly", "root/a-convcolonly",
          "colliders/a", "root/colliders/a", "colliders/deep/a", "a/colliders/b/c"}) {
        EXPECT_TRUE(is_collider(path)) << path;
    }
    // The other names of Godot mark meshes that are shown too.
    for (const char* path :
         {"", "a", "a-col", "a-convcol", "a_convex", "xUCX_a", "UCX_a/b", "ucx_a", "a-colonly/b",
          "colliders", "root/colliders", "mycolliders/a"}) {
        EXPECT_FALSE(is_collider(path)) << path;
    }
}

TEST(FindColliders, FindsWhatWouldBeLeftOut) {
    EXPECT_EQ(find_colliders(with_instances({"root/a-colonly", "b", "UCX_b_00"})),
              (Names{"root/a-colonly", "UCX_b_00"}));
    EXPECT_EQ(find_colliders(with_groups({"a", "UCX_a_00", "b"})), Names{"UCX_a_00"});
    EXPECT_EQ(find_colliders(with_instances({"a", "b", "c"})), Names{});
    EXPECT_EQ(find_colliders(with_instances({"UCX_a", "UCX_b", "c-colonly"})), Names{});
    EXPECT_EQ(kept_text(Names{"UCX_b"}, "with --without-colliders"),
              "1 collider is a part of the mesh: UCX_b. Leave it out with --without-colliders.");
    EXPECT_EQ(kept_text(Names{"a", "b", "c", "d", "e"}, "with --without-colliders"),
              "5 colliders are a part of the mesh: a, b, c and 2 more. Leave them out with "
              "--without-colliders.");
}

TEST(LeaveOutColliders, LeavesTheOtherNodes) {
    TriangleSoup soup = with_instances({"root/a-colonly", "b", "UCX_b_00"});
    const TriangleSoup given = soup;
    EXPECT_EQ(leave_out_colliders(soup), (Names{"root/a-colonly", "UCX_b_00"}));
    ASSERT_EQ(soup.triangles.size(), 12U);
    EXPECT_EQ(soup.positions.size(), 8U);
    EXPECT_EQ(soup.instance_names, Names{"b"});
    ASSERT_EQ(soup.instances.size(), 1U);
    EXPECT_EQ(soup.instances[0].mesh, 8U);
    EXPECT_EQ(soup.instances[0].name, 0U);
    EXPECT_EQ(soup.instances[0].first_triangle, 0U);
    EXPECT_EQ(soup.instances[0].triangle_count, 12U);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(soup.face[i], i) << "faces keep their numbers, which count within a node";
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(soup.positions[soup.triangles[i].vertex[k]],
                      given.positions[given.triangles[12 + i].vertex[k]]);
        }
    }
}

// Groups share vertices; materials run across groups.
TEST(LeaveOutColliders, LeavesTheOtherGroups) {
    TriangleSoup soup = with_groups({"a", "UCX_a", "b"});
    soup.materials = {{{0, 6, 0, 0}, {6, 12, 1, 0}, {18, 18, 0, 0}}, {"red", "blue"}};
    soup.triangles[12].vertex[0] = 0;  // a collider uses a vertex of the first cube
    soup.face.resize(36);
    for (std::uint32_t i = 0; i < 36; ++i) soup.face[i] = 100 + i;
    EXPECT_EQ(leave_out_colliders(soup), Names{"UCX_a"});
    EXPECT_EQ(soup.triangles.size(), 24U);
    EXPECT_EQ(soup.positions.size(), 16U);
    EXPECT_EQ(soup.groups.names, (Names{"a", "b"}));
    ASSERT_EQ(soup.groups.runs.size(), 2U);
    EXPECT_EQ(soup.groups.runs[1].first_triangle, 12U);
    EXPECT_EQ(soup.groups.runs[1].name, 1U);
    ASSERT_EQ(soup.materials.runs.size(), 3U);
    EXPECT_EQ(soup.materials.runs[1].first_triangle, 6U);
    EXPECT_EQ(soup.materials.runs[1].triangle_count, 6U);
    EXPECT_EQ(soup.materials.runs[2].triangle_count, 12U);
    EXPECT_EQ(soup.face[11], 111U);
    EXPECT_EQ(soup.face[12], 124U);
}

TEST(LeaveOutColliders, JoinsRunsOfOneName) {
    TriangleSoup soup = with_groups({"a", "a-colonly", "b"});
    soup.groups.runs[2].name = 0;
    EXPECT_EQ(leave_out_colliders(soup), Names{"a-colonly"});
    EXPECT_EQ(soup.groups.names, Names{"a"});
    ASSERT_EQ(soup.groups.runs.size(), 1U);
    EXPECT_EQ(soup.groups.runs[0].triangle_count, 24U);
}

TEST(LeaveOutColliders, KeepsVerticesThatNothingUses) {
    TriangleSoup soup = with_groups({"a", "UCX_a", "b"});
    soup.positions.insert(soup.positions.begin(), {9, 9, 9});
    for (auto& triangle : soup.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) ++vertex;
    }
    EXPECT_EQ(leave_out_colliders(soup), Names{"UCX_a"});
    EXPECT_EQ(soup.positions.size(), 17U);
    EXPECT_EQ(soup.positions.front(), (format::Double3{9, 9, 9}));
}

// 0.1 is no float: the last cube alone needs doubles.
TEST(LeaveOutColliders, FindsTheirPrecisionAnew) {
    TriangleSoup soup = with_groups({"a", "b", "UCX_a"});
    ASSERT_EQ(leave_out_colliders(soup), Names{"UCX_a"});
    EXPECT_TRUE(soup.single_precision);
    soup = with_groups({"UCX_a", "a", "b"});
    ASSERT_EQ(leave_out_colliders(soup), Names{"UCX_a"});
    EXPECT_FALSE(soup.single_precision);
}

TEST(LeftOutText, NamesThreeAtMost) {
    EXPECT_EQ(left_out_text(Names{"a"}),
              "1 collider was left out: a. Keep it with --with-colliders.");
    EXPECT_EQ(left_out_text(Names{"a", "b"}),
              "2 colliders were left out: a and b. Keep them with --with-colliders.");
    EXPECT_EQ(left_out_text(Names{"a", "b", "c"}),
              "3 colliders were left out: a, b and c. Keep them with --with-colliders.");
    EXPECT_EQ(left_out_text(Names{"a", "b", "c", "d", "e"}),
              "5 colliders were left out: a, b, c and 2 more. Keep them with --with-colliders.");
}

TEST(LeaveOutColliders, RemovesNothingFromWhatHasNothingElse) {
    for (TriangleSoup soup :
         {with_groups({"UCX_a", "UCX_b", "c-colonly"}), with_groups({"a", "b", "c"}),
          with_instances({"UCX_a", "UCX_b", "colliders/c"}), cubes()}) {
        EXPECT_EQ(leave_out_colliders(soup), Names{});
        EXPECT_EQ(soup.triangles.size(), 36U);
        EXPECT_TRUE(soup.face.empty());
    }
    TriangleSoup bad = with_groups({"a", "UCX_b", "c"});
    bad.bad_number_count = 1;
    EXPECT_EQ(leave_out_colliders(bad), Names{});
    EXPECT_EQ(bad.triangles.size(), 36U);
}

}  // namespace
}  // namespace cdprep::cli
