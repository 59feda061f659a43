// SPDX-License-Identifier: MIT
#include "study/memory_model.h"

#include <gtest/gtest.h>

#include "cdprep/cells.h"
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/contacts.h"
#include "cdprep/hulls.h"
#include "support/open_tiny.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

std::vector<TrianglePair> pairs_of(const Model& a, const Model& b, const StructureOptions& through,
                                   const Placement& placement) {
    Workspace workspace(cells());
    std::vector<TrianglePair> pairs(10'000);
    pairs.resize(overlaps_through({a, b, placement}, through, workspace, pairs));
    return pairs;
}

// Both bakers take the same mesh: the answers are exact, so they agree.
TEST(MemoryModel, AnswersAsAFileDoesThroughEveryPart) {
    const test::TestMesh mesh = test::in_floats(test::torus(1, 0.4, 24, 12));
    MemoryParts parts;
    parts.octree = build::OctreeOptions{.level = 4, .hashed = true, .boxes_in = build::Frame{}};
    parts.adaptive_octree = build::AdaptiveOctreeOptions{.level = 3};
    parts.tetra_tree =
        build::TetraTreeOptions{.level = 3, .bounding = format::TetraBounding::boxes};
    parts.hulls = true;
    parts.pieces = true;
    const auto made = make_memory_model(test::mesh_of(mesh), parts);
    ASSERT_TRUE(made);
    const Model& model = made.value().model;
    const test::OpenModel tiny = test::open_tiny(mesh);
    const auto pose = Pose::from_quaternion(0.9, 0.2, -0.3, 0.1, {0.7, 0.2, 0.1});
    const Placement placement = Placement::b_moves(pose.value());
    const auto expected = pairs_of(tiny.model, tiny.model, {}, placement);
    EXPECT_GT(expected.size(), 20U);
    for (const Structure structure :
         {Structure::bvh, Structure::octree, Structure::hashed_octree, Structure::adaptive_octree,
          Structure::tetra_tree, Structure::pieces}) {
        EXPECT_EQ(pairs_of(model, model, {.structure = structure}, placement), expected);
    }
    EXPECT_TRUE(model.is_balanced());
    EXPECT_TRUE(find_hull(model, format::HullScope::whole));
    EXPECT_EQ(bytes_of(made.value(), {SectionId::triangles}), mesh.triangles.size() * 12);
    EXPECT_EQ(bytes_of(made.value(), {SectionId::triangle_piece}), mesh.triangles.size() * 4);
    Workspace workspace(cells());
    EXPECT_GT(contacts({model, model, placement}, workspace, {}, {.tolerance = 0.01}).found, 0U);
}

TEST(MemoryModel, IsAMeshAgain) {
    const mesh::Mesh mesh = test::mesh_of(test::icosphere(2));  // coordinates that are no floats
    const auto made = make_memory_model(mesh);
    ASSERT_TRUE(made);
    const mesh::Mesh again = mesh_of(made.value().model);
    ASSERT_EQ(again.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(bytes_of(made.value(), {SectionId::pieces}), 0U);
    EXPECT_FALSE(again.single_precision);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            EXPECT_EQ(again.positions[again.triangles[i].vertex[corner]],
                      mesh.positions[mesh.triangles[i].vertex[corner]]);
        }
    }
}

// Numbers of the model's source name the triangle of the mesh.
TEST(MemoryModel, KeepsTheMeshInItsOwnOrder) {
    for (const bool single : {false, true}) {
        mesh::Mesh mesh = test::mesh_of(test::unit_cube());
        mesh.single_precision = single;
        const auto made = make_memory_model(mesh);
        ASSERT_TRUE(made);
        const mesh::Mesh& ordered = made.value().ordered;
        EXPECT_EQ(ordered.single_precision, single);
        ASSERT_EQ(ordered.triangles.size(), mesh.triangles.size());
        ASSERT_EQ(ordered.source_vertex.size(), mesh.positions.size());
        for (std::size_t i = 0; i < ordered.positions.size(); ++i) {
            EXPECT_EQ(ordered.positions[i], mesh.positions[ordered.source_vertex[i]]);
        }
    }
}

TEST(MemoryModel, TakesAMeshOfNothing) {
    const auto made = make_memory_model({}, {.hulls = true});
    ASSERT_TRUE(made);
    EXPECT_EQ(made.value().model.triangle_count(), 0U);
}

}  // namespace
}  // namespace cdprep::study
