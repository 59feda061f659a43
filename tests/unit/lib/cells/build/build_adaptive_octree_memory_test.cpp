// SPDX-License-Identifier: MIT
// In a program of its own, whose memory is all counted.
#include <gtest/gtest.h>

#include "cdprep/cells/build_adaptive_octree.h"
#include "support/counted_memory.h"
#include "support/meshes.h"

namespace cdprep::test {
namespace {

// The bound of build_adaptive_octree.h, and a page for what does not grow.
TEST(BuildAdaptiveOctree, TakesNoMoreMemoryThanItSays) {
    for (const TestMesh& mesh : {icosphere(6), random_soup(4, 40'000, 0.1)}) {
        for (const auto rule : {format::SplitRule::median, format::SplitRule::surface_area}) {
            for (const auto& [level, threshold] : {std::pair{3U, 1U}, {6U, 16U}, {8U, 4U}}) {
                const std::size_t before = used;
                most = used;
                const build::AdaptiveOctree octree = build::build_adaptive_octree(
                    mesh.positions, mesh.triangles,
                    {.level = level, .threshold = threshold, .rule = rule});
                const std::size_t nodes = octree.nodes.size();
                const std::size_t references = octree.references.size();
                const std::size_t result = nodes * sizeof octree.nodes[0] + 4 * references;
                const std::size_t scratch = most - before - result;
                const std::size_t bound =
                    build::kAdaptiveScratchPerTriangle * mesh.triangles.size() +
                    build::kAdaptiveScratchPerReference * references +
                    build::kAdaptiveScratchPerNode * nodes + 4096;
                EXPECT_LE(scratch, bound) << level;
                EXPECT_GT(scratch, bound / 5) << level;  // the bound says something
            }
        }
    }
}

}  // namespace
}  // namespace cdprep::test
