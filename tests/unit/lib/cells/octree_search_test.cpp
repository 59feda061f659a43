// SPDX-License-Identifier: MIT
#include "cdprep/cells/octree_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "cdprep/cells/overlap_through.h"
#include "cells/octree_codes.h"
#include "support/every_structure.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

using build::Octree;
using format::OctreeNode;

constexpr std::uint64_t kAllCodes = std::uint64_t{1} << 63;

/// How a random tree is shaped.
struct Shape {
    std::uint32_t level = 4;      ///< no deeper
    double inner = 0.6;           ///< share of cells above that which are divided
    double kept = 0.6;            ///< share of children that are there
    std::size_t most = 2000;      ///< nodes, about
    std::uint32_t top_level = 2;  ///< at most `level`
    std::uint32_t slot_bits = 6;
};

/// Children of nodes[parent], appended.
void add_children(std::vector<OctreeNode>& nodes, std::size_t parent, std::uint32_t mask) {
    nodes[parent].first = static_cast<std::uint32_t>(nodes.size());
    nodes[parent].count = format::kInnerNode | mask;
    const std::uint64_t key = nodes[parent].key;
    for (std::uint32_t child = 0; child < 8; ++child) {
        if ((mask >> child) & 1U) nodes.push_back({key << 3 | child, 0, 1});
    }
}

std::vector<OctreeNode> random_nodes(std::mt19937_64& random, const Shape& shape) {
    std::bernoulli_distribution divides(shape.inner);
    std::bernoulli_distribution keeps(shape.kept);
    std::vector<OctreeNode> nodes = {{1, 0, 1}};
    for (std::size_t i = 0; i < nodes.size() && nodes.size() < shape.most; ++i) {
        if (level_of(nodes[i].key) >= shape.level || (i > 0 && !divides(random))) continue;
        std::uint32_t mask = 1U << (random() % 8);
        for (std::uint32_t child = 0; child < 8; ++child) {
            if (keeps(random)) mask |= 1U << child;
        }
        add_children(nodes, i, mask);
    }
    return nodes;
}

void add_leaves(Octree& octree) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> leaves;
    for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
        if (is_leaf(octree.nodes[i])) leaves.emplace_back(code_of(octree.nodes[i].key), i);
    }
    std::sort(leaves.begin(), leaves.end());
    for (const auto& [code, node] : leaves) {
        octree.leaf_codes.push_back(code);
        octree.leaf_nodes.push_back(node);
    }
    const std::uint64_t cells = std::uint64_t{1} << (3 * octree.grid.top_level);
    for (std::uint64_t cell = 0; cell <= cells; ++cell) {
        const auto before = [&](const auto& leaf) {
            return cell == cells || leaf.first < cell * cells_below(octree.grid.top_level);
        };
        octree.top.push_back(
            static_cast<std::uint32_t>(std::count_if(leaves.begin(), leaves.end(), before)));
    }
}

std::vector<std::uint32_t> chains(const Octree& octree,
                                  std::uint64_t (*slot_of)(std::uint64_t, std::uint32_t)) {
    const std::size_t slots = std::size_t{1} << octree.grid.slot_bits;
    std::vector<std::uint32_t> table(slots + octree.nodes.size());
    for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
        const std::size_t slot = slot_of(octree.nodes[i].key, octree.grid.slot_bits);
        table[slots + i] = table[slot];
        table[slot] = i + 1;
    }
    return table;
}

Octree random_octree(std::mt19937_64& random, const Shape& shape) {
    Octree octree;
    octree.grid = {{-1, 2, 0.5}, 3e-7, shape.level, 1, shape.top_level, shape.slot_bits};
    octree.nodes = random_nodes(random, shape);
    add_leaves(octree);
    octree.modulus_table = chains(octree, [](std::uint64_t key, std::uint32_t bits) {
        return key % (std::uint64_t{1} << bits);
    });
    octree.mixed_table = chains(octree, [](std::uint64_t key, std::uint32_t bits) {
        return bits == 0 ? std::uint64_t{0} : (key * format::kKeyMixer) >> (64 - bits);
    });
    return octree;
}

/// Down from the root, by the three bits of each level.
std::uint32_t descend(const std::vector<OctreeNode>& nodes, std::uint64_t code) {
    if (nodes.empty()) return kNoNode;
    std::uint32_t at = 0;
    for (std::uint32_t shift = 60; !is_leaf(nodes[at]); shift -= 3) {
        const std::uint32_t child = (code >> shift) & 7U;
        if (((nodes[at].count >> child) & 1U) == 0) return kNoNode;
        const std::uint32_t before = nodes[at].count & ((1U << child) - 1);
        at = nodes[at].first + static_cast<std::uint32_t>(std::popcount(before));
    }
    return at;
}

void expect_same_leaf(const Octree& octree, std::uint64_t code) {
    const std::uint32_t expected = descend(octree.nodes, code);
    for (const CellSearch search : kSearches) {
        EXPECT_EQ(find_leaf(octree_index(octree), search, code), expected)
            << "search " << static_cast<int>(search) << ", code " << code;
    }
}

/// First, last, before and after each leaf: where searches go wrong.
std::vector<std::uint64_t> codes_around_leaves(const Octree& octree) {
    std::vector<std::uint64_t> codes = {0, kAllCodes - 1};
    for (const OctreeNode& node : octree.nodes) {
        const std::uint64_t first = code_of(node.key);
        const std::uint64_t next = first + cells_below(level_of(node.key));
        codes.insert(codes.end(), {first, next - 1});
        if (first > 0) codes.push_back(first - 1);
        if (next < kAllCodes) codes.push_back(next);
    }
    return codes;
}

std::vector<Shape> shapes() {
    return {
        {},
        {.level = 0, .top_level = 0, .slot_bits = 0},
        {.level = 1, .inner = 1, .kept = 0.5, .top_level = 1, .slot_bits = 1},
        {.level = 21, .inner = 0.9, .kept = 0.15, .top_level = 0, .slot_bits = 12},
        {.level = 21, .inner = 0.95, .kept = 0.1, .top_level = 4, .slot_bits = 3},
        {.level = 21, .inner = 0.3, .kept = 1, .top_level = 3, .slot_bits = 8},
        {.level = 3, .inner = 1, .kept = 1, .top_level = 3, .slot_bits = 10},
        {.level = 6, .inner = 0.7, .kept = 0.7, .top_level = 0, .slot_bits = 0},
    };
}

// The oracle: a descent of the nodes.
TEST(OctreeSearch, EveryWayFindsTheLeafThatADescentFinds) {
    std::mt19937_64 random(1);
    std::size_t found = 0;
    std::size_t asked = 0;
    for (int round = 0; round < 20; ++round) {
        for (const Shape& shape : shapes()) {
            const Octree octree = random_octree(random, shape);
            for (int i = 0; i < 300; ++i) {
                const std::uint64_t code = random() % kAllCodes;
                expect_same_leaf(octree, code);
                ++asked;
                if (descend(octree.nodes, code) != kNoNode) ++found;
            }
        }
    }
    EXPECT_GT(found, asked * 3 / 10);
    EXPECT_LT(found, asked * 7 / 10);
}

// The same oracle, where cells meet.
TEST(OctreeSearch, FirstAndLastCodesOfCellsAndTheirNeighboursAreFound) {
    std::mt19937_64 random(2);
    std::size_t empty = 0;
    std::size_t asked = 0;
    for (const Shape& shape : shapes()) {
        const Octree octree = random_octree(random, shape);
        for (const std::uint64_t code : codes_around_leaves(octree)) {
            expect_same_leaf(octree, code);
            ++asked;
            if (descend(octree.nodes, code) == kNoNode) ++empty;
        }
    }
    EXPECT_GT(empty, asked / 10);
    EXPECT_LT(empty, asked / 2);
}

// By the definition of a node's number: its place.
TEST(OctreeSearch, EveryWayFindsEveryNodeAndNoOther) {
    std::mt19937_64 random(3);
    for (const Shape& shape : shapes()) {
        const Octree octree = random_octree(random, shape);
        const OctreeIndex index = octree_index(octree);
        for (const CellSearch search : kSearches) {
            for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
                const OctreeNode& node = octree.nodes[i];
                ASSERT_EQ(find_node(index, search, node.key), i);
                if (level_of(node.key) == format::kOctreeBits) continue;
                for (std::uint64_t child = 0; child < 8; ++child) {
                    const bool is_there = !is_leaf(node) && ((node.count >> child) & 1U) != 0;
                    ASSERT_EQ(find_node(index, search, node.key << 3 | child) != kNoNode, is_there);
                }
            }
            EXPECT_EQ(find_node(index, search, 0), kNoNode);
            EXPECT_EQ(find_node(index, search, ~std::uint64_t{0}) != kNoNode,
                      octree.nodes.back().key == ~std::uint64_t{0});
        }
    }
}

/// Bit by bit.
std::uint64_t slow_code(const CellPlace& place) {
    std::uint64_t code = 0;
    for (std::uint32_t bit = 0; bit < format::kOctreeBits; ++bit) {
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            code |= static_cast<std::uint64_t>((place[axis] >> bit) & 1U) << (3 * bit + axis);
        }
    }
    return code;
}

/// Down from the root, by comparing with the plane between the halves: no keys.
std::uint32_t descend(const Octree& octree, const Double3& point) {
    const std::array<double, 3> at = {point.x, point.y, point.z};
    const std::array<double, 3> origin = {octree.grid.origin.x, octree.grid.origin.y,
                                          octree.grid.origin.z};
    std::array<std::uint32_t, 3> lower{};
    std::uint32_t node = 0;
    for (std::uint32_t half = kOctreeSteps / 2; !is_leaf(octree.nodes[node]); half /= 2) {
        std::uint32_t child = 0;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            if (at[axis] < octree_plane(origin[axis], octree.grid.step, lower[axis] + half)) {
                continue;
            }
            child |= 1U << axis;
            lower[axis] += half;
        }
        const std::uint32_t mask = octree.nodes[node].count;
        if (((mask >> child) & 1U) == 0) return kNoNode;
        const std::uint32_t before = mask & ((1U << child) - 1);
        node = octree.nodes[node].first + static_cast<std::uint32_t>(std::popcount(before));
    }
    return node;
}

/// A coordinate inside, on a plane, one step off it in double, far outside or infinite.
double hard_coordinate(std::mt19937_64& random, double origin, double step) {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::uint32_t levels = static_cast<std::uint32_t>(random() % 8);
    const auto plane = static_cast<std::uint32_t>(random() % ((1U << levels) + 1))
                       << (format::kOctreeBits - levels);
    const double on_plane = octree_plane(origin, step, plane);
    switch (random() % 8) {
        case 0:
        case 1:
            return on_plane;
        case 2:
            return std::nextafter(on_plane, -infinity);
        case 3:
            return std::nextafter(on_plane, infinity);
        case 4:
            return random() % 2 == 0 ? -1e300 : infinity;
        default:
            return std::uniform_real_distribution<double>(
                origin, octree_plane(origin, step, kOctreeSteps))(random);
    }
}

// The oracle compares coordinates with planes, level by level; a point outside goes where
// the nearest inside would. Grids of any size and place.
TEST(OctreeSearch, PointsOnPlanesAtCornersAndOutsideAreFoundAsComparingFindsThem) {
    std::mt19937_64 random(4);
    std::size_t found = 0;
    std::size_t asked = 0;
    for (const double step : {0x1p-1021, 0x1.8p-30, 0x1.2345678p0, 0x1p970}) {
        for (const double offset : {0.0, -1048576.0, 7.3}) {
            Octree octree = random_octree(random, {.level = 7, .inner = 0.7, .kept = 0.7});
            octree.grid.origin = {offset * step, -step, offset * step * 0.1};
            octree.grid.step = step;
            for (int i = 0; i < 1000; ++i) {
                const Double3 point = {hard_coordinate(random, octree.grid.origin.x, step),
                                       hard_coordinate(random, octree.grid.origin.y, step),
                                       hard_coordinate(random, octree.grid.origin.z, step)};
                const std::uint32_t expected = descend(octree, point);
                const std::uint64_t code = slow_code(octree_cell(octree.grid, point));
                for (const CellSearch search : kSearches) {
                    ASSERT_EQ(find_leaf(octree_index(octree), search, code), expected);
                }
                ++asked;
                if (expected != kNoNode) ++found;
            }
        }
    }
    EXPECT_GT(found, asked * 3 / 10);
    EXPECT_LT(found, asked * 7 / 10);
}

// A model's sections and a builder's vectors are the same tree; the oracle: a descent. At
// level 21 cells end around the corners, where the most triangles meet.
TEST(OctreeSearch, AModelsOctreeIsSearchedAsTheBuildersIs) {
    std::mt19937_64 random(5);
    const TestMesh sphere = icosphere(2);
    const AlignedBytes bare = bake_tiny(sphere.positions, sphere.triangles);
    for (const std::uint32_t level : {0U, 3U, 6U, 21U}) {
        const build::OctreeOptions options{.level = level, .threshold = 6};
        const OpenModel open = open_tiny(with_octree(bare, options));
        const BuilderInput input = builder_input(open.model);
        const Octree octree = build::build_octree(input.positions, input.triangles, options);
        const OctreeIndex index = octree_index(open.model);
        std::size_t found = 0;
        for (int i = 0; i < 2000; ++i) {
            const Double3& p = input.positions[random() % input.positions.size()];
            std::uint64_t code = octree_code(octree_cell(octree.grid, p));
            if (i % 2 == 0) code = random() % kAllCodes;
            const std::uint32_t expected = descend(octree.nodes, code);
            for (const CellSearch search : kSearches) {
                ASSERT_EQ(find_leaf(index, search, code), expected);
                ASSERT_EQ(find_leaf(octree_index(octree), search, code), expected);
            }
            if (expected != kNoNode) ++found;
        }
        EXPECT_GE(found, 1000U);
        // Half of the codes are corners', half anywhere.
        EXPECT_LT(found, level < 6 ? 2001U : 1700U);
    }
}

// By definition.
TEST(OctreeSearch, NothingIsFoundWithoutNodes) {
    Octree octree;
    octree.top = {0, 0};
    octree.modulus_table = {0};
    octree.mixed_table = {0};
    for (const CellSearch search : kSearches) {
        EXPECT_EQ(find_leaf(octree_index(octree), search, 5), kNoNode);
        EXPECT_EQ(find_node(octree_index(octree), search, 1), kNoNode);
    }
}

// By the header: an index needs a grid, in every build.
TEST(OctreeIndexDeathTest, AModelWithoutAnOctreeStopsTheProgram) {
    const OpenModel bare = open_tiny(icosphere(1));
    EXPECT_DEATH((void)octree_index(bare.model), "octree needs");
}

}  // namespace
}  // namespace cdprep::test
