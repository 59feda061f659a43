// SPDX-License-Identifier: MIT
#include "repair/repair_steps.h"

#include <gtest/gtest.h>

#include "unit/tools/repair_mesh_of.h"

namespace cdprep::mesh {
namespace {

/// A strip of `columns` squares, cut in two triangles each; 1 high.
test::TestMesh strip(int columns, double step, double x) {
    test::TestMesh made;
    for (int i = 0; i <= columns; ++i) {
        made.positions.push_back({x + i * step, 0, 0});
        made.positions.push_back({x + i * step, 1, 0});
    }
    for (int i = 0; i < columns; ++i) {
        const auto low = static_cast<std::uint32_t>(2 * i);
        made.triangles.push_back({{low, low + 2, low + 3}});
        made.triangles.push_back({{low, low + 3, low + 1}});
    }
    return made;
}

// Its border has edges of 1/16, and 3/16 is the width: a chain would join all its vertices.
TEST(StitchSeams, AFinelyDividedBorderDoesNotCollapse) {
    const test::TestMesh sheet = strip(16, 0.0625, 0);
    const Stepped done = stitch_seams(test::repair_mesh_of(sheet), 0.1875);
    EXPECT_EQ(done.mesh.triangles, sheet.triangles);
    EXPECT_EQ(done.mesh.positions, sheet.positions);
    EXPECT_TRUE(done.report.merged.empty());
    EXPECT_EQ(done.report.moved, 0.0);
    ASSERT_EQ(done.report.refused.size(), 2U);
    EXPECT_EQ(done.report.refused[0].vertices.size(), 17U);
    EXPECT_EQ(done.report.refused[0].measure, 1.0);
    EXPECT_EQ(done.report.refused[0].sentence,
              "the chain of 17 vertices at vertex 0 would move by 1.000000; the seam width allows "
              "0.187500.");
}

// Beside it, a seam of 1/8 between two squares is stitched as ever.
TEST(StitchSeams, SeamsBesideARefusedChainAreStitched) {
    const test::TestMesh squares = test::joined(strip(1, 1, 10), strip(1, 1, 11.125));
    const Stepped done =
        stitch_seams(test::repair_mesh_of(test::joined(strip(16, 0.0625, 0), squares)), 0.1875);
    EXPECT_EQ(done.report.refused.size(), 2U);
    ASSERT_EQ(done.report.merged.size(), 2U);
    EXPECT_EQ(done.report.merged[0].source, 38U);
    EXPECT_EQ(done.report.merged[0].into, 36U);
    EXPECT_EQ(done.report.moved, 0.125);
    EXPECT_EQ(done.mesh.triangles.size(), 36U);
    EXPECT_EQ(done.mesh.positions.size(), 40U);
}

}  // namespace
}  // namespace cdprep::mesh
