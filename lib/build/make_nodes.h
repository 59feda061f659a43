// SPDX-License-Identifier: MIT
#pragma once

#include "build/lanes.h"
#include "cdprep/advanced/build_bvh.h"

namespace cdprep::build {

/// Fills the levels of a hierarchy's nodes above the lowest, from the lowest.
void make_nodes(std::span<format::BvhNode> all, std::uint32_t triangle_count,
                ParallelFor parallel_for);

/// Sets a box of a node to the one around the boxes of the node below.
void set_box_around(format::BvhNode& node, std::size_t box, const format::BvhNode& below);

/// Returns half the area of each box of a node; 0 for unused ones.
[[nodiscard]] Lanes<double, format::kBvhWidth> half_areas(const format::BvhNode& node);

/// Returns half the area of the box around the boxes of a node; 0 if all are unused.
[[nodiscard]] double half_area_around(const format::BvhNode& node);

/// Marks a box as unused: a place without contents.
void set_unused_box(format::BvhNode& node, std::size_t box);

/// Marks boxes from `first` on as unused.
void set_unused_boxes(format::BvhNode& node, std::size_t first);

}  // namespace cdprep::build
