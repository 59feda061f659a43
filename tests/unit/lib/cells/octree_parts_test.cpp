// SPDX-License-Identifier: MIT
#include "cells/octree_parts.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "cdprep/cells/overlap_through.h"
#include "cells/octree_codes.h"
#include "support/every_structure.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

/// Triangles that a part lists, followed down to its leaves.
void add_triangles(const OctreeParts& parts, const OctreePart& part, const CellPlace& first,
                   std::uint32_t level, std::set<std::uint32_t>& triangles) {
    if (part.empty()) return;
    if (parts.is_single_leaf(part)) {
        for (const std::uint32_t reference : parts.references(part)) {
            triangles.insert(reference & ~format::kSharedReference);
        }
        return;
    }
    const std::uint32_t steps = kOctreeSteps >> (level + 1);
    for (unsigned i = 0; i < 8; ++i) {
        const CellPlace at = {first[0] + (i & 1) * steps, first[1] + (i >> 1 & 1) * steps,
                              first[2] + (i >> 2) * steps};
        const std::uint64_t code = octree_code(at);
        if (((parts.children(part) >> i) & 1) == 0) continue;
        const OctreePart child = parts.child(part, i, code, level + 1);
        ASSERT_EQ(parts.has_child(part, i, code, level + 1), !child.empty());
        add_triangles(parts, child, at, level + 1, triangles);
    }
}

/// The same by the definition: of leaves whose cell is in the cell, or that hold it.
std::set<std::uint32_t> listed_in(const Model& model, std::uint64_t code, std::uint32_t level) {
    std::set<std::uint32_t> triangles;
    for (const format::OctreeNode& node : model.octree().nodes) {
        if ((node.count & format::kInnerNode) != 0) continue;
        const std::uint64_t own = format::code_of(node.key);
        const std::uint64_t size = format::cells_below(format::level_of(node.key));
        const bool below = own >= code && own < code + format::cells_below(level);
        const bool holds = code >= own && code < own + size;
        if (!below && !holds) continue;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            triangles.insert(model.octree().references[node.first + i] & ~format::kSharedReference);
        }
    }
    return triangles;
}

// The oracle: all leaves, one after the other. Cells of every level that have triangles, and
// cells drawn at random, most of which have none.
TEST(OctreeParts, EveryCellHasThePartOfTheDefinition) {
    std::mt19937 random(51);
    std::size_t filled = 0, empty = 0;
    for (const build::OctreeOptions& options : {build::OctreeOptions{.level = 4, .threshold = 6},
                                                build::OctreeOptions{.level = 7, .threshold = 1},
                                                build::OctreeOptions{.level = 0, .threshold = 1}}) {
        const OpenModel open = open_with_octree(random_soup(random(), 60, 0.2), options);
        const Model& model = open.model;
        const OctreeIndex index = octree_index(model);
        for (int round = 0; round < 300; ++round) {
            const auto level = static_cast<std::uint32_t>(random() % (index.deepest + 1));
            const auto& some = index.nodes[random() % index.nodes.size()];
            std::uint64_t code = round % 2 == 0 ? format::code_of(some.key)
                                                : (std::uint64_t{random()} << 31 | random());
            code = code % format::cells_below(0) / format::cells_below(level) *
                   format::cells_below(level);
            const auto expected = listed_in(model, code, level);
            (expected.empty() ? empty : filled) += 1;
            const CellPlace first = octree_place(key_at(code, level));
            for (const CellSearch search :
                 {CellSearch::sorted, CellSearch::modulus, CellSearch::mixed}) {
                const OctreeParts parts(index, model.octree().references, search);
                std::set<std::uint32_t> triangles;
                add_triangles(parts, parts.at(code, level), first, level, triangles);
                ASSERT_TRUE(triangles == expected)
                    << "level " << level << ", search " << static_cast<int>(search);
            }
        }
    }
    EXPECT_GT(filled, 200U);
    EXPECT_GT(empty, 100U);
}

}  // namespace
}  // namespace cdprep::test
