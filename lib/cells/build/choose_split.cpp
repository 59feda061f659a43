// SPDX-License-Identifier: MIT
#include "cells/build/choose_split.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "build/frame_map.h"

namespace cdprep::build {
namespace {

struct Interval {
    double lower;
    double upper;
};

Interval reach_of(const Box3& box, std::size_t axis) {
    return {coordinate(box.lower, axis), coordinate(box.upper, axis)};
}

/// Returns the midpoint: finite and between the two, for all coordinates that models have.
double middle(const Interval& reach) {
    return reach.lower + (reach.upper - reach.lower) / 2;
}

bool is_inside(double x, const Interval& reach) {
    return reach.lower < x && x < reach.upper;
}

/// Calls body(reach) with the extent of each triangle's box along the axis.
template <class Body>
void for_reaches(const CellContent& cell, std::size_t axis, Body body) {
    for (const std::uint32_t reference : cell.list) {
        body(reach_of(cell.boxes[reference & ~format::kSharedReference], axis));
    }
}

bool leaves_one_whole(const CellContent& cell, std::size_t axis, double plane) {
    return std::any_of(cell.list.begin(), cell.list.end(), [&](std::uint32_t reference) {
        const Interval reach = reach_of(cell.boxes[reference & ~format::kSharedReference], axis);
        return reach.upper < plane || plane < reach.lower;
    });
}

double median_middle(const CellContent& cell, std::size_t axis, std::vector<double>& middles) {
    assert(!cell.list.empty());
    const Interval all = reach_of(cell.box, axis);
    middles.clear();
    middles.reserve(cell.list.size());
    for_reaches(cell, axis, [&](const Interval& reach) {
        middles.push_back(
            middle({std::max(reach.lower, all.lower), std::min(reach.upper, all.upper)}));
    });
    const auto half = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::nth_element(middles.begin(), half, middles.end());
    return *half;
}

AxisSplit by_median(const CellContent& cell, std::size_t axis, std::vector<double>& scratch) {
    const Interval all = reach_of(cell.box, axis);
    double plane = median_middle(cell, axis, scratch);
    if (!is_inside(plane, all)) plane = middle(all);
    if (!is_inside(plane, all)) return {all.upper, false};
    return {plane, leaves_one_whole(cell, axis, plane)};
}

constexpr std::size_t kSlices = 16;

/// The planes between slices, and the number of triangles on each side of every plane. Triangles
/// that a plane cuts count on both sides.
struct Slices {
    std::array<double, kSlices - 1> plane;
    std::array<std::size_t, kSlices - 1> below;
    std::array<std::size_t, kSlices - 1> above;
};

Slices slices_of(const CellContent& cell, std::size_t axis) {
    const Interval all = reach_of(cell.box, axis);
    Slices slices{};
    for (std::size_t i = 0; i + 1 < kSlices; ++i) {
        slices.plane[i] =
            all.lower + (all.upper - all.lower) * (static_cast<double>(i + 1) / double{kSlices});
    }
    std::array<std::size_t, kSlices> begun{};
    std::array<std::size_t, kSlices> ended{};
    for_reaches(cell, axis, [&](const Interval& reach) {
        std::size_t begin = 0;
        std::size_t end = 0;
        for (const double plane : slices.plane) {
            begin += plane < reach.lower ? 1 : 0;
            end += plane <= reach.upper ? 1 : 0;
        }
        ++begun[begin];
        ++ended[end];
    });
    std::size_t below = 0;
    std::size_t above = cell.list.size();
    for (std::size_t i = 0; i + 1 < kSlices; ++i) {
        below += begun[i];
        above -= ended[i];
        slices.below[i] = below;
        slices.above[i] = above;
    }
    return slices;
}

/// Half the surface area of a cell that is cut across an axis: `across` is fixed, and `along` is
/// multiplied by the part's share. In units of the longest side, so that no model's size leaves the
/// range of double.
struct HalfArea {
    double across;
    double along;

    HalfArea(const Box3& box, std::size_t axis) {
        std::array<double, 3> side{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Interval reach = reach_of(box, (axis + i) % 3);
            side[i] = reach.upper - reach.lower;
        }
        const double longest = std::max({side[0], side[1], side[2]});
        assert(longest > 0);
        for (double& length : side) length /= longest;
        across = side[1] * side[2];
        along = side[0] * (side[1] + side[2]);
    }
    [[nodiscard]] double of(double share) const {
        return across + along * share;
    }
};

AxisSplit by_surface_area(const CellContent& cell, std::size_t axis) {
    const Interval all = reach_of(cell.box, axis);
    const std::size_t count = cell.list.size();
    AxisSplit best{all.upper, false};
    if (!(all.lower < all.upper)) return best;
    const Slices slices = slices_of(cell, axis);
    const HalfArea area(cell.box, axis);
    double least = 0;
    for (std::size_t i = 0; i + 1 < kSlices; ++i) {
        // From the middle one outwards.
        const std::size_t middle_one = kSlices / 2 - 1;
        const std::size_t k = i % 2 == 0 ? middle_one + i / 2 : middle_one - (i + 1) / 2;
        if (!is_inside(slices.plane[k], all)) continue;
        const double share = static_cast<double>(k + 1) / double{kSlices};
        const double cost = area.of(share) * static_cast<double>(slices.below[k]) +
                            area.of(1 - share) * static_cast<double>(slices.above[k]);
        if (best.plane != all.upper && cost >= least) continue;
        best = {slices.plane[k], slices.below[k] < count || slices.above[k] < count};
        least = cost;
    }
    return best;
}

}  // namespace

AxisSplit choose_split(const CellContent& cell, std::size_t axis, format::SplitRule rule,
                       std::vector<double>& scratch) {
    if (rule == format::SplitRule::surface_area) return by_surface_area(cell, axis);
    return by_median(cell, axis, scratch);
}

}  // namespace cdprep::build
