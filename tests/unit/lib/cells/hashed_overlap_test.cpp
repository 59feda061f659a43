// SPDX-License-Identifier: MIT
#include "cells/hashed_overlap.h"

#include <gtest/gtest.h>

#include "cells/octree_cells.h"
#include "support/brute_force.h"
#include "support/every_structure.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"

namespace cdprep::test {
namespace {

/// Two models with octrees.
struct TwoModels {
    TestMesh mesh_a;
    TestMesh mesh_b;
    OpenModel a;
    OpenModel b;

    TwoModels(const TestMesh& of_a, const TestMesh& of_b, const build::OctreeOptions& octree = {},
              const TinyOptions& options = {})
        : mesh_a(of_a),
          mesh_b(of_b),
          a(open_tiny(with_octree(bake_tiny(of_a.positions, of_a.triangles, options), octree))),
          b(open_tiny(with_octree(bake_tiny(of_b.positions, of_b.triangles, options), octree))) {}

    [[nodiscard]] std::vector<TrianglePair> through(const StructureOptions& structure,
                                                    const Placement& placement) const {
        Workspace workspace(cells());
        std::vector<TrianglePair> pairs(
            overlaps_through({a.model, b.model, placement}, structure, workspace, {}));
        pairs.resize(overlaps_through({a.model, b.model, placement}, structure, workspace, pairs));
        return pairs;
    }
    [[nodiscard]] std::vector<TrianglePair> hashed(const Placement& placement,
                                                   CellSearch search = {}) const {
        return through({.structure = Structure::hashed_octree, .search = search}, placement);
    }
    [[nodiscard]] std::vector<TrianglePair> expected(const Placement& placement) const {
        return brute_force_pairs(mesh_a, mesh_b, placement);
    }
};

const Placement kAsTheyAre = Placement::b_moves(Pose());

TestMesh one_triangle(const Double3& p, const Double3& q, const Double3& r) {
    return {{p, q, r}, {{{0, 1, 2}}}};
}

// B12: a triangle with corners ten radii away goes through the sphere, and no corner is in any
// cell.
TEST(HashedOverlap, ABigTriangleThroughASmallModelIsFound) {
    const TwoModels models(icosphere(3), one_triangle({10, 0.1, 0}, {-7, 9, 0.3}, {-7, -9, 0.2}),
                           {.level = 5, .threshold = 4});
    const auto expected = models.expected(kAsTheyAre);
    ASSERT_GT(expected.size(), 30U);
    for (const CellSearch search : kSearches) {
        EXPECT_EQ(models.hashed(kAsTheyAre, search), expected);
    }
}

// The same with the roles exchanged: now the big triangle's octree is asked.
TEST(HashedOverlap, ASmallModelThroughABigTriangleIsFound) {
    const TwoModels models(one_triangle({10, 0.1, 0}, {-7, 9, 0.3}, {-7, -9, 0.2}), icosphere(3),
                           {.level = 5, .threshold = 4});
    const auto expected = models.expected(kAsTheyAre);
    ASSERT_GT(expected.size(), 30U);
    EXPECT_EQ(models.hashed(kAsTheyAre), expected);
}

// By construction: a triangle larger than the root all round misses the model by little.
TEST(HashedOverlap, ATriangleLargerThanTheRootThatMissesHasNoPairs) {
    const TwoModels models(icosphere(2),
                           one_triangle({99, 0, 1.001}, {-70, 90, 1.001}, {-70, -90, 1.001}));
    EXPECT_TRUE(models.hashed(kAsTheyAre).empty());
    EXPECT_EQ(
        models.hashed(Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, {0, 0, -0.5}).value())),
        models.expected(
            Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, {0, 0, -0.5}).value())));
}

// B13. A sheet in a plane between cells, against itself, half a square on, and with its
// corners moved onto the planes of cells: brute force knows.
TEST(HashedOverlap, TrianglesOnCellPlanesAreFoundOnce) {
    const TestMesh sheet = grid_sheet(8, 8);
    for (const std::uint32_t level : {1U, 3U, 6U}) {
        const TwoModels models(sheet, sheet, {.level = level, .threshold = 1});
        const format::OctreeGrid& grid = *models.a.model.octree().grid;
        const double plane = octree_plane(grid.origin.x, grid.step, 1U << 20);
        std::vector<Placement> placements = {kAsTheyAre};
        for (const Double3& shift : {Double3{0.5, 0, 0}, Double3{plane - 4, plane - 4, 0},
                                     Double3{plane - 3, 1, 0}, Double3{0, 0, 0x1p-40}}) {
            placements.push_back(
                Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, shift).value()));
        }
        for (const Placement& placement : placements) {
            for (const CellSearch search : kSearches) {
                ASSERT_EQ(models.hashed(placement, search), models.expected(placement)) << level;
            }
        }
    }
}

// B10 and the ends of the range: the same pairs at any size and place that loses nothing.
TEST(HashedOverlap, SizeAndPlaceDoNotMatter) {
    const TestMesh a = icosphere(2), b = torus(1, 0.25, 16, 8);
    const std::size_t pairs = TwoModels(a, b).expected(kAsTheyAre).size();
    ASSERT_GT(pairs, 50U);
    for (const int exponent : {-1000, -300, -20, 0, 20, 300, 990}) {
        const double scale = std::ldexp(1.0, exponent);
        const TwoModels models(moved_by(a, scale, {0, 0, 0}), moved_by(b, scale, {0, 0, 0}),
                               {.level = 6, .threshold = 4}, {.double_precision = true});
        EXPECT_EQ(models.hashed(kAsTheyAre).size(), pairs) << exponent;
    }
    const TwoModels far(moved_by(a, 0x1p-10, {1e6, -1e6, 1e6}),
                        moved_by(b, 0x1p-10, {1e6, -1e6, 1e6}), {.level = 8, .threshold = 2},
                        {.double_precision = true});
    EXPECT_EQ(far.hashed(kAsTheyAre), far.expected(kAsTheyAre));
    const Placement turned =
        Placement::b_moves(Pose::from_quaternion(1, 1e-9, 0, 0, {0x1p-12, 0, 0}).value());
    EXPECT_EQ(far.hashed(turned), far.expected(turned));
}

// One model is 2^2000 times the other, which is a point to it.
TEST(HashedOverlap, ModelsOfIncomparableSizesMeetWhereTheyDo) {
    const TestMesh small = moved_by(icosphere(1), 0x1p-990, {0, 0, 0});
    const TestMesh large =
        one_triangle({0x1p990, 0, 0}, {-0x1p990, 0x1p990, 0}, {-0x1p990, -0x1p990, 0});
    const TwoModels models(small, large, {.level = 6, .threshold = 2}, {.double_precision = true});
    const auto expected = models.expected(kAsTheyAre);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(models.hashed(kAsTheyAre), expected);
    const TwoModels exchanged(large, small, {.level = 6, .threshold = 2},
                              {.double_precision = true});
    EXPECT_EQ(exchanged.hashed(kAsTheyAre), exchanged.expected(kAsTheyAre));
}

// B11: flat, a single point, one triangle, nothing.
TEST(HashedOverlap, TrivialMeshesHaveDefinedAnswers) {
    const std::vector<TestMesh> meshes = {
        grid_sheet(3, 2), one_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}),
        one_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), unit_cube(), TestMesh{}};
    for (const TestMesh& a : meshes) {
        for (const TestMesh& b : meshes) {
            const TwoModels models(a, b, {.level = 4, .threshold = 2}, {.double_precision = true});
            EXPECT_EQ(models.hashed(kAsTheyAre), models.expected(kAsTheyAre));
        }
    }
}

// By the table of needs: files without an octree or without its tables do not serve the question.
TEST(HashedOverlapDeathTest, StopsWhereAModelWasNotBakedForIt) {
    const TestMesh cube = unit_cube();
    const OpenModel plain = open_tiny(cube);
    const OpenModel whole = open_tiny(with_octree(bake_tiny(cube.positions, cube.triangles)));
    const OpenModel without_tables =
        open_tiny(with_octree(bake_tiny(cube.positions, cube.triangles), {.hashed = false}));
    Workspace workspace(cells());
    const StructureOptions through = {.structure = Structure::hashed_octree};
    EXPECT_TRUE(any_overlap_through({whole.model, whole.model, kAsTheyAre}, through, workspace));
    for (const OpenModel* other : {&plain, &without_tables}) {
        EXPECT_DEATH(
            (void)any_overlap_through({whole.model, other->model, kAsTheyAre}, through, workspace),
            "hashed-octree needs");
        EXPECT_DEATH(
            (void)any_overlap_through({other->model, whole.model, kAsTheyAre}, through, workspace),
            "hashed-octree needs");
    }
}

// By the meaning of the counts.
// By hand: two triangles that cross, each in the one cell of its octree.
TEST(HashedOverlap, TheWorkOfOnePairIsCountedExactly) {
    const TwoModels models(one_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}),
                           one_triangle({1, 1, -1}, {1, 1, 1}, {2, 1, 1}), {.level = 0});
    Workspace workspace(cells());
    QueryCounts counts;
    workspace.count_into(&counts);
    const Pair pair = {models.a.model, models.b.model, kAsTheyAre};
    const StructureOptions through = {.structure = Structure::hashed_octree};
    ASSERT_EQ(overlaps_through(pair, through, workspace, {}), 1U);
    EXPECT_EQ(counts.potential, 8U);  // a leaf's lanes, one of them used
    EXPECT_EQ(counts.cells_sought, 1U);
    EXPECT_EQ(counts.references, 1U);
    EXPECT_EQ(counts.leaf_pairs, 1U);
    EXPECT_EQ(counts.triangle_pairs, 1U);
}

TEST(HashedOverlap, QuestionsAreCounted) {
    const TwoModels models(icosphere(3), icosphere(2), {.level = 4, .threshold = 8});
    const Placement placement =
        Placement::b_moves(Pose::from_quaternion(1, 0.1, 0, 0, {0.5, 0.25, 0}).value());
    Workspace workspace(cells());
    QueryCounts counts;
    workspace.count_into(&counts);
    const StructureOptions through = {.structure = Structure::hashed_octree};
    ASSERT_GT(overlaps_through({models.a.model, models.b.model, placement}, through, workspace, {}),
              0U);
    EXPECT_GT(counts.potential, 0U);
    EXPECT_LE(counts.potential, models.mesh_b.triangles.size() + 7);
    EXPECT_GT(counts.cells_sought, 0U);
    EXPECT_GT(counts.references, 0U);
    EXPECT_GT(counts.leaf_pairs, 0U);
}

}  // namespace
}  // namespace cdprep::test
