// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/inaccessible/cap_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "query/inaccessible/radial_cover.h"
#include "support/meshes.h"
#include "support/run_threads.h"

namespace cdprep::mesh {
namespace {

using test::TestMesh;

constexpr Double3 kCentre = {0, 0, 0};

/// Triangles of sizes from 8 to 2^-22, some about the centre: of all classes and of none.
TestMesh many_sizes() {
    TestMesh mesh =
        test::joined(test::moved_by(test::icosphere(0), 8, kCentre), test::random_soup(5, 60, 2));
    double size = 1;
    for (std::uint32_t i = 0; i < 12; ++i, size /= 4) {
        mesh = test::joined(mesh, test::random_soup(6 + i, 20, size));
    }
    return test::joined(mesh, test::coarse_grid_soup(1, 60, 1));
}

// A pair that hides exactly is found: where one alone hides another, it is among the others.
TEST(CapTree, FindsWhateverHides) {
    for (const TestMesh& mesh :
         {many_sizes(), test::joined(test::moved_by(test::icosphere(2), 0.25, {0.1, 0, 0}),
                                     test::moved_by(test::unit_cube(), 4, {-2, -2, -2}))}) {
        const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
        const RadialCover cover(kCentre, mesh.positions, mesh.triangles);
        const CapTree caps(kCentre, mesh.positions, mesh.triangles);
        std::vector<std::uint32_t> others;
        int hiding = 0;
        for (std::uint32_t t = 0; t < count; ++t) {
            caps.find_others(t, others);
            std::sort(others.begin(), others.end());
            EXPECT_EQ(std::adjacent_find(others.begin(), others.end()), others.end());
            EXPECT_FALSE(std::binary_search(others.begin(), others.end(), t));
            for (std::uint32_t s = 0; s < count; ++s) {
                if (!cover.is_hidden(t, {&s, 1})) continue;
                ++hiding;
                EXPECT_TRUE(std::binary_search(others.begin(), others.end(), s)) << s << ' ' << t;
            }
        }
        EXPECT_GT(hiding, 40);
    }
}

TEST(CapTree, LeavesOutWhatIsElsewhere) {
    const TestMesh mesh = test::icosphere(4);
    const CapTree caps(kCentre, mesh.positions, mesh.triangles);
    std::size_t most = 0;
    std::vector<std::uint32_t> others;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        caps.find_others(t, others);
        most = std::max(most, others.size());
    }
    EXPECT_GE(most, 3U);
    EXPECT_LT(most, 40U);
}

TEST(CapTree, IsTheSameForAnyThreads) {
    const TestMesh mesh = test::joined(many_sizes(), test::icosphere(4));
    const CapTree one(kCentre, mesh.positions, mesh.triangles);
    const CapTree many(kCentre, mesh.positions, mesh.triangles, test::run_threads);
    std::vector<std::uint32_t> by_one;
    std::vector<std::uint32_t> by_many;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 7) {
        one.find_others(t, by_one);
        many.find_others(t, by_many);
        ASSERT_EQ(by_one, by_many);
    }
}

}  // namespace
}  // namespace cdprep::mesh
