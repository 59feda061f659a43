// SPDX-License-Identifier: MIT
// In a program of its own, whose memory is all counted.
#include <gtest/gtest.h>

#include "cdprep/cells/build_octree.h"
#include "support/counted_memory.h"
#include "support/meshes.h"

namespace cdprep::test {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& elements) {
    return elements.size() * sizeof(T);
}

std::size_t result_bytes(const build::Octree& octree) {
    return bytes_of(octree.nodes) + bytes_of(octree.references) + bytes_of(octree.leaf_codes) +
           bytes_of(octree.leaf_nodes) + bytes_of(octree.top) + bytes_of(octree.modulus_table) +
           bytes_of(octree.mixed_table);
}

// The bound of build_octree.h, and a page for what does not grow. Tables come last, when all
// else is done with: without them there is most besides the result.
TEST(BuildOctree, TakesNoMoreMemoryThanItSays) {
    for (const TestMesh& mesh : {icosphere(6), random_soup(4, 40'000, 0.1)}) {
        for (const build::OctreeOptions& options :
             {build::OctreeOptions{.hashed = false},
              build::OctreeOptions{.level = 6, .threshold = 16, .hashed = false},
              build::OctreeOptions{.level = 8, .threshold = 4, .hashed = false}}) {
            const std::size_t before = used;
            most = used;
            const build::Octree octree = build_octree(mesh.positions, mesh.triangles, options);
            const std::size_t scratch = most - before - result_bytes(octree);
            const std::size_t bound = build::kScratchPerVertex * mesh.positions.size() +
                                      build::kScratchPerReference * octree.references.size() +
                                      build::kScratchPerNode * octree.nodes.size() + 4096;
            EXPECT_LE(scratch, bound);
            EXPECT_GT(scratch, bound / 4);  // the bound says something
        }
    }
}

}  // namespace
}  // namespace cdprep::test
