// SPDX-License-Identifier: MIT
#include "cells/build/cell_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cells/octree_cells.h"
#include "cells/octree_codes.h"
#include "cells/split_box.h"
#include "support/bvh_boxes.h"
#include "support/meshes.h"

namespace cdprep::build {
namespace {

using format::CellBox;
using test::TestMesh;

std::array<double, 3> as_array(const Double3& p) {
    return {p.x, p.y, p.z};
}

/// A float that is the exact number, or the next one outside of it.
bool is_rounded_down(float rounded, const test::ExactNumber& exact) {
    const float next = std::nextafter(rounded, std::numeric_limits<float>::infinity());
    return test::ExactNumber(rounded) <= exact && exact < test::ExactNumber(next);
}

/// Each leaf's box is the one that format/octree.h describes, worked out in exact arithmetic
/// and as tight as floats allow.
void expect_tight_leaf(const TestMesh& mesh, std::span<const std::uint32_t> references,
                       const Box3& cell, const CellBox& box, const Frame& frame) {
    const auto cell_lower = as_array(cell.lower), cell_upper = as_array(cell.upper);
    const auto origin = as_array(frame.origin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (const std::uint32_t reference : references) {
            double lower = std::numeric_limits<double>::infinity(), upper = -lower;
            for (const auto v : mesh.triangles[reference & ~format::kSharedReference].vertex) {
                const double x = as_array(mesh.positions[v])[axis];
                lower = std::min(lower, x);
                upper = std::max(upper, x);
            }
            least = std::min(least, std::max(lower, cell_lower[axis]));
            most = std::max(most, std::min(upper, cell_upper[axis]));
        }
        const auto exact_least = test::in_frame(least, origin[axis], frame.exponent);
        const auto exact_most = test::in_frame(most, origin[axis], frame.exponent);
        EXPECT_TRUE(is_rounded_down(box.lower[axis], exact_least)) << axis;
        EXPECT_TRUE(is_rounded_down(-box.upper[axis], -exact_most)) << axis;
    }
}

void expect_union(const CellBox& box, std::span<const CellBox> children) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float lower = children[0].lower[axis], upper = children[0].upper[axis];
        for (const CellBox& child : children) {
            lower = std::min(lower, child.lower[axis]);
            upper = std::max(upper, child.upper[axis]);
        }
        EXPECT_EQ(box.lower[axis], lower);
        EXPECT_EQ(box.upper[axis], upper);
    }
}

/// Whose positions are floats in a frame of origin 0, so that roundings do not add up.
std::vector<TestMesh> meshes() {
    return {test::unit_cube(),
            test::icosphere(3),
            test::random_soup(3, 400, 0.3),
            test::coarse_grid_soup(5, 200, 4),
            test::grid_sheet(9, 9),
            test::copies_of_one_triangle(5),
            test::moved_by(test::random_soup(3, 200, 0.3), 1e-3, {1e6, -1e6, 1e6}),
            test::moved_by(test::icosphere(2), 0x1p-1000, {}),
            test::moved_by(test::icosphere(2), 0x1p999, {})};
}

template <class Node>
void expect_boxes(const TestMesh& mesh, std::span<const Node> nodes,
                  std::span<const std::uint32_t> references, std::span<const CellBox> boxes,
                  const std::vector<Box3>& cells, const Frame& frame) {
    ASSERT_EQ(boxes.size(), nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if ((nodes[i].count & format::kInnerNode) == 0) {
            expect_tight_leaf(mesh, references.subspan(nodes[i].first, nodes[i].count), cells[i],
                              boxes[i], frame);
        } else {
            const auto children = static_cast<std::size_t>(std::popcount(nodes[i].count & 0xff));
            expect_union(boxes[i], boxes.subspan(nodes[i].first, children));
        }
    }
}

TEST(CellBoxes, AreTightAroundWhatAnOctreesCellsHold) {
    for (const TestMesh& mesh : meshes()) {
        const Frame frame = build_bvh(mesh.positions, mesh.triangles).frame;
        const Octree octree = build_octree(mesh.positions, mesh.triangles,
                                           {.level = 4, .threshold = 6, .boxes_in = frame});
        std::vector<Box3> cells;
        for (const format::OctreeNode& node : octree.nodes) {
            cells.push_back(octree_box(octree.grid, octree_place(node.key), level_of(node.key)));
        }
        expect_boxes<format::OctreeNode>(mesh, octree.nodes, octree.references, octree.boxes, cells,
                                         frame);
    }
}

TEST(CellBoxes, AreTightAroundWhatAnAdaptiveOctreesCellsHold) {
    for (const TestMesh& mesh : meshes()) {
        const Frame frame = build_bvh(mesh.positions, mesh.triangles).frame;
        for (const auto rule : {format::SplitRule::median, format::SplitRule::surface_area}) {
            const AdaptiveOctree octree = build_adaptive_octree(
                mesh.positions, mesh.triangles,
                {.level = 4, .threshold = 6, .rule = rule, .boxes_in = frame});
            std::vector<Box3> cells(octree.nodes.size());
            cells[0] = {octree.tree.lower, octree.tree.upper};
            for (std::size_t i = 0; i < octree.nodes.size(); ++i) {
                const format::AdaptiveOctreeNode& node = octree.nodes[i];
                if ((node.count & format::kInnerNode) == 0) continue;
                std::size_t next = node.first;
                for (std::size_t child = 0; child < 8; ++child) {
                    if ((node.count >> child & 1) == 0) continue;
                    cells[next++] = split_box(cells[i], node.split, child);
                }
            }
            expect_boxes<format::AdaptiveOctreeNode>(mesh, octree.nodes, octree.references,
                                                     octree.boxes, cells, frame);
        }
    }
}

TEST(CellBoxes, AreThereOnlyWhereTheyWereAskedFor) {
    const TestMesh mesh = test::icosphere(2);
    EXPECT_TRUE(build_octree(mesh.positions, mesh.triangles, {}).boxes.empty());
    EXPECT_TRUE(build_adaptive_octree(mesh.positions, mesh.triangles, {}).boxes.empty());
    EXPECT_TRUE(build_octree({}, {}, {.boxes_in = Frame{}}).boxes.empty());
    EXPECT_TRUE(build_adaptive_octree({}, {}, {.boxes_in = Frame{}}).boxes.empty());
}

}  // namespace
}  // namespace cdprep::build
