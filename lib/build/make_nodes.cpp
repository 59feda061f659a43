// SPDX-License-Identifier: MIT
#include "build/make_nodes.h"

#include <array>
#include <cassert>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep::build {
namespace {

using format::BvhNode;
using format::BvhShape;
using format::kBvhWidth;

}  // namespace

// Unused boxes, at 1 and -1, leave every union unchanged: no coordinate lies outside [-1, 1].
void set_box_around(BvhNode& node, std::size_t box, const BvhNode& below) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.lower[axis][box] = least(below.lower[axis]);
        node.upper[axis][box] = greatest(below.upper[axis]);
    }
}

// The sides of unused boxes are -2: they count as 0.
Lanes<double, kBvhWidth> half_areas(const BvhNode& node) {
    Lanes<double, kBvhWidth> area;
    for_lanes<kBvhWidth>([&](std::size_t box) {
        const double x = double{node.upper[0][box]} - double{node.lower[0][box]};
        const double y = double{node.upper[1][box]} - double{node.lower[1][box]};
        const double z = double{node.upper[2][box]} - double{node.lower[2][box]};
        area[box] = x < 0 ? 0 : x * y + y * z + z * x;
    });
    return area;
}

double half_area_around(const BvhNode& node) {
    std::array<double, 3> side{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        side[axis] = double{greatest(node.upper[axis])} - double{least(node.lower[axis])};
    }
    return side[0] < 0 ? 0 : side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

void set_unused_box(BvhNode& node, std::size_t box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.lower[axis][box] = 1;
        node.upper[axis][box] = -1;
    }
}

void set_unused_boxes(BvhNode& node, std::size_t first) {
    assert(first <= kBvhWidth);
    for (std::size_t box = first; box < kBvhWidth; ++box) set_unused_box(node, box);
}

void make_nodes(std::span<BvhNode> all, std::uint32_t triangle_count, ParallelFor parallel_for) {
    const BvhShape shape = format::bvh_shape(triangle_count);
    assert(all.size() == shape.node_count);
    constexpr std::size_t kNodesPerTask = 256;
    for (std::uint32_t level = 1; level < shape.levels; ++level) {
        BvhNode* const nodes = &all[shape.first[level]];
        const BvhNode* const below = &all[shape.first[level - 1]];
        const auto make = [&](std::size_t i) {
            const std::uint32_t used = shape.used_boxes(level, static_cast<std::uint32_t>(i));
            for (std::size_t box = 0; box < used; ++box) {
                set_box_around(nodes[i], box, below[i * kBvhWidth + box]);
            }
            set_unused_boxes(nodes[i], used);
        };
        for_chunks(shape.count[level], kNodesPerTask, parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) make(i);
                   });
    }
}

}  // namespace cdprep::build
