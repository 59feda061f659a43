// SPDX-License-Identifier: MIT
#include "accuracy/octree_level.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cdprep/pairs.h"
#include "study/memory_model.h"
#include "support/random_pose.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

CellModel cells_of(const mesh::Mesh& mesh, std::uint32_t level) {
    return {build::build_octree(mesh.positions, mesh.triangles,
                                {.level = level, .threshold = 1, .hashed = false})};
}

// Cells hold the surface, and none of their points is farther from it than their diagonal: so
// they meet wherever surfaces do, and never where these are two diagonals apart.
TEST(CellsMayMeet, IsRightButForTheCellsDiagonals) {
    const mesh::Mesh a = test::mesh_of(test::torus(1, 0.4, 20, 10));
    const mesh::Mesh b = test::mesh_of(test::icosphere(2));
    const MemoryModel model_a = make_memory_model(a).value();
    const MemoryModel model_b = make_memory_model(b).value();
    Workspace workspace;
    std::vector<std::uint64_t> pending;
    std::vector<std::uint64_t> visits;
    for (const std::uint32_t level : {0U, 2U, 4U}) {
        const CellModel cells_a = cells_of(a, level);
        const CellModel cells_b = cells_of(b, level);
        const double reach = std::sqrt(3.0) * (cells_a.edge() + cells_b.edge());
        std::mt19937 random(31);
        int met = 0;
        int apart = 0;
        int between = 0;
        std::uint64_t visited = 0;
        for (int i = 0; i < 800; ++i) {
            const Pose pose = test::random_pose(random, 4);
            const bool meet = cells_may_meet(cells_a, cells_b, pose, pending, &visited);
            const double gap =
                distance({model_a.model, model_b.model, Placement::b_moves(pose)}, workspace)
                    ->upper;
            if (gap == 0) {
                EXPECT_TRUE(meet);
                ++met;
            } else if (gap > reach) {
                EXPECT_FALSE(meet);
                ++apart;
            } else {
                ++between;
            }
        }
        EXPECT_GT(met, 20) << level;
        EXPECT_GT(level < 2 ? between : apart, 20) << level;
        visits.push_back(visited);
    }
    EXPECT_EQ(visits, (std::vector<std::uint64_t>{800, 5436, 28069})) << "recorded: pairs of cells";
}

TEST(CellsMayMeet, NothingMeetsNothing) {
    const CellModel nothing = cells_of({}, 3);
    const CellModel cube = cells_of(test::mesh_of(test::unit_cube()), 3);
    std::vector<std::uint64_t> pending;
    EXPECT_FALSE(cells_may_meet(nothing, cube, Pose(), pending));
    std::uint64_t visited = 0;
    EXPECT_TRUE(cells_may_meet(cube, cube, Pose(), pending, &visited));
    EXPECT_GE(visited, 1U);
}

}  // namespace
}  // namespace cdprep::study
