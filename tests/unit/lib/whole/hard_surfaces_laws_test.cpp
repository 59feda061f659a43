// SPDX-License-Identifier: MIT
// D05 to D07: surfaces that are no solid's are answered exactly, as any other.
#include <gtest/gtest.h>

#include <random>

#include "cdprep/pairs.h"
#include "support/brute_force_distance.h"
#include "support/defect_zoo.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

/// About 2 wide, around the origin, on floats.
std::vector<TestMesh> surfaces() {
    const TestMesh cube = moved_by(unit_cube(), 1, {-1, -1, -1});
    std::vector<TestMesh> all = {
        three_sheets(),                                      // an edge of three triangles
        joined(cube, moved_by(unit_cube(), 1, {})),          // a vertex of two bodies
        joined(cube, moved_by(unit_cube(), 1, {0, 0, -1})),  // an edge of two
        moved_by(moebius_strip(12), 0x1p-6, {}),
        moved_by(klein_bottle(8, 7), 0.5, {}),
        upper_half(icosphere(1)),
    };
    for (TestMesh& mesh : all) mesh = in_floats(mesh);
    return all;
}

// The oracle: every pair of triangles, by segments; the distance by rationals.
TEST(HardSurfacesLaws, AreAnsweredAsByDefinition) {
    const std::vector<TestMesh> all = surfaces();
    std::mt19937 random(567);
    Workspace workspace;
    int touching = 0, asked = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = i; j < all.size(); ++j) {
            const OpenModel a = open_tiny(all[i]), b = open_tiny(all[j]);
            for (int round = 0; round < 5; ++round) {
                SCOPED_TRACE(testing::Message() << i << " and " << j << ", round " << round);
                const Pose pose = round == 0 ? Pose() : random_pose(random, 2);
                const Placement placement = Placement::b_moves(pose);
                const auto pairs = all_pairs(a.model, b.model, placement, workspace);
                EXPECT_EQ(pairs, brute_force_pairs(all[i], all[j], placement));
                EXPECT_EQ(collide({a.model, b.model, placement}, workspace).hit == Answer::yes,
                          !pairs.empty());
                const auto found = distance({a.model, b.model, placement}, workspace);
                const ExactRational truth = brute_force_distance(all[i], all[j], placement);
                EXPECT_TRUE(square(found->lower) <= truth && truth <= square(found->upper));
                EXPECT_EQ(found->upper == 0, !pairs.empty());
                touching += pairs.empty() ? 0 : 1;
                ++asked;
            }
        }
    }
    EXPECT_GT(touching, asked * 3 / 10);
    EXPECT_LT(touching, asked * 7 / 10);
}

}  // namespace
}  // namespace cdprep::test
