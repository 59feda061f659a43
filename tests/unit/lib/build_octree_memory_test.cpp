// SPDX-License-Identifier: MIT
// In a program of its own, whose memory is all counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

#include "cdprep/build_octree.h"
#include "support/meshes.h"

namespace {

std::size_t used = 0;
std::size_t most = 0;

/// In front of each block: its size. As large as any alignment that is needed.
constexpr std::size_t kFront = alignof(std::max_align_t);

void* counted(std::size_t size) {
    auto* block = static_cast<std::byte*>(std::malloc(kFront + size));
    if (block == nullptr) std::abort();
    std::memcpy(block, &size, sizeof size);
    used += size;
    most = std::max(most, used);
    return block + kFront;
}

void forget(void* memory) noexcept {
    if (memory == nullptr) return;
    std::byte* block = static_cast<std::byte*>(memory) - kFront;
    std::size_t size = 0;
    std::memcpy(&size, block, sizeof size);
    used -= size;
    std::free(block);
}

}  // namespace

void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void operator delete(void* memory) noexcept {
    forget(memory);
}
void operator delete[](void* memory) noexcept {
    forget(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
    forget(memory);
}
void operator delete[](void* memory, std::size_t /*size*/) noexcept {
    forget(memory);
}

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
