// SPDX-License-Identifier: MIT
#include "cells/build/cell_boxes.h"

#include <algorithm>
#include <cassert>

#include "build/frame_map.h"
#include "cdprep/advanced/parallel_for.h"
#include "cells/octree_cells.h"
#include "cells/octree_codes.h"
#include "cells/split_box.h"
#include "core/numbers.h"

// Boxes are computed in model coordinates, where minima and maxima of corners and planes are exact.
// They are rounded once, outwards, on conversion to the frame.

namespace cdprep::build {
namespace {

using format::CellBox;
using format::kInnerNode;

constexpr std::size_t kCellsPerTask = 256;

constexpr Box3 kNothing = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

/// Widens `box` by the intersection of two boxes that touch.
void add_common(const Box3& a, const Box3& b, Box3& box) {
    assert(overlap(a, b));
    const auto add = [](double lower_a, double lower_b, double upper_a, double upper_b,
                        double& lower, double& upper) {
        lower = std::min(lower, std::max(lower_a, lower_b));
        upper = std::max(upper, std::min(upper_a, upper_b));
    };
    add(a.lower.x, b.lower.x, a.upper.x, b.upper.x, box.lower.x, box.upper.x);
    add(a.lower.y, b.lower.y, a.upper.y, b.upper.y, box.lower.y, box.upper.y);
    add(a.lower.z, b.lower.z, a.upper.z, b.upper.z, box.lower.z, box.upper.z);
}

CellBox in_frame(const Box3& box, const FrameMap& frame) {
    CellBox result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result.lower[axis] = frame.around(coordinate(box.lower, axis), axis).lower;
        result.upper[axis] = frame.around(coordinate(box.upper, axis), axis).upper;
    }
    return result;
}

CellBox around(const CellBox& a, const CellBox& b) {
    CellBox result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
        result.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
    }
    return result;
}

/// Returns the cells of all nodes.
std::vector<Box3> cells_of(const Octree& octree) {
    std::vector<Box3> cells;
    cells.reserve(octree.nodes.size());
    for (const format::OctreeNode& node : octree.nodes) {
        cells.push_back(octree_box(octree.grid, octree_place(node.key), level_of(node.key)));
    }
    return cells;
}
std::vector<Box3> cells_of(const AdaptiveOctree& octree) {
    std::vector<Box3> cells(octree.nodes.size());
    if (!cells.empty()) cells[0] = {octree.tree.lower, octree.tree.upper};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const format::AdaptiveOctreeNode& node = octree.nodes[i];
        if ((node.count & kInnerNode) == 0) continue;
        assert(node.first > i);  // children follow their parents
        std::size_t child = node.first;
        for (unsigned rest = node.count & 0xff; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            cells[child++] = split_box(cells[i], node.split, lane);
        }
    }
    return cells;
}

/// The lists and triangles of a tree, for bounding.
struct Listing {
    std::span<const std::uint32_t> references;
    std::span<const format::Double3> positions;
    std::span<const format::Triangle> triangles;

    [[nodiscard]] Box3 around_listed(std::uint32_t first, std::uint32_t count,
                                     const Box3& cell) const {
        Box3 box = kNothing;
        for (const std::uint32_t reference : references.subspan(first, count)) {
            const auto& v = triangles[reference & ~format::kSharedReference].vertex;
            add_common(box_around({positions[v[0]], positions[v[1]], positions[v[2]]}), cell, box);
        }
        return box;
    }
};

template <class Tree>
void bound(Tree& tree, const Listing& listing, const Frame& frame, ParallelFor parallel_for) {
    const FrameMap map(frame);
    const std::vector<Box3> cells = cells_of(tree);
    tree.boxes.resize(tree.nodes.size());
    for_chunks(cells.size(), kCellsPerTask, parallel_for, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto& node = tree.nodes[i];
            if ((node.count & kInnerNode) != 0) continue;
            tree.boxes[i] = in_frame(listing.around_listed(node.first, node.count, cells[i]), map);
        }
    });
    // Children follow their parents.
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const auto& node = tree.nodes[i];
        if ((node.count & kInnerNode) == 0) continue;
        const auto children = static_cast<std::size_t>(std::popcount(node.count & 0xff));
        assert(node.first > i && children > 0 && node.first + children <= tree.nodes.size());
        tree.boxes[i] = tree.boxes[node.first];
        for (std::size_t k = 1; k < children; ++k) {
            tree.boxes[i] = around(tree.boxes[i], tree.boxes[node.first + k]);
        }
    }
}

}  // namespace

void bound_cells(Octree& octree, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const Frame& frame,
                 ParallelFor parallel_for) {
    bound(octree, {octree.references, positions, triangles}, frame, parallel_for);
}

void bound_cells(AdaptiveOctree& octree, std::span<const format::Double3> positions,
                 std::span<const format::Triangle> triangles, const Frame& frame,
                 ParallelFor parallel_for) {
    bound(octree, {octree.references, positions, triangles}, frame, parallel_for);
}

}  // namespace cdprep::build
