// SPDX-License-Identifier: MIT
#include "repair/repair_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "unit/tools/repair_mesh_of.h"

namespace cdprep::mesh {
namespace {

/// A triangle over a base that is cut into `count` pieces by a fan of flat triangles at vertex 0.
test::TestMesh flat_fan(std::uint32_t count) {
    test::TestMesh made;
    for (std::uint32_t i = 0; i <= count; ++i) made.positions.push_back({double(i), 0, 0});
    made.positions.push_back({count / 2.0, double(count), 0});
    made.triangles.push_back({{0, count, count + 1}});
    for (std::uint32_t i = 1; i < count; ++i) made.triangles.push_back({{0, i + 1, i}});
    return made;
}

// Only the last flat triangle has a neighbour with area; each that is mended gives one to the one
// before. Takes minutes if every pass tries all.
TEST(DropZeroArea, ALongFanOfFlatTrianglesIsMended) {
    constexpr std::uint32_t kCount = 20'000;
    const Stepped done = drop_zero_area(test::repair_mesh_of(flat_fan(kCount)));
    EXPECT_TRUE(done.report.refused.empty());
    ASSERT_EQ(done.report.dropped.size(), kCount - 1);
    for (std::uint32_t i = 0; i + 1 < kCount; ++i) {
        ASSERT_EQ(done.report.dropped[i].source, kCount - 1 - i);
    }
    ASSERT_EQ(done.mesh.triangles.size(), kCount);
    std::vector<bool> found(kCount, false);  // the pieces of the base, below the one apex
    for (test::Triangle t : done.mesh.triangles) {
        std::rotate(t.vertex.begin(), std::max_element(t.vertex.begin(), t.vertex.end()),
                    t.vertex.end());
        ASSERT_EQ(t.vertex[0], kCount + 1);
        ASSERT_EQ(t.vertex[2], t.vertex[1] + 1);
        found[t.vertex[1]] = true;
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), true), kCount);
}

// The flat triangle 1 waits for its neighbour 2, which stays as its own neighbour has no area.
TEST(DropZeroArea, EveryTriangleThatStaysIsRefusedOnce) {
    test::TestMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 5, 0}};
    mesh.triangles = {{{0, 3, 1}}, {{3, 0, 2}}, {{0, 1, 4}}};
    const Stepped done = drop_zero_area(test::repair_mesh_of(mesh));
    ASSERT_EQ(done.report.refused.size(), 2U);
    EXPECT_EQ(done.report.refused[0].triangles, std::vector<std::uint32_t>{0});
    EXPECT_EQ(done.report.refused[1].triangles, std::vector<std::uint32_t>{1});
    EXPECT_EQ(done.report.refused[0].sentence,
              "triangle 0 has no area, and its neighbour across the longest edge has no area "
              "either.");
    EXPECT_EQ(done.mesh.triangles, mesh.triangles);
}

}  // namespace
}  // namespace cdprep::mesh
