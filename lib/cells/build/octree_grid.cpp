// SPDX-License-Identifier: MIT
#include "cells/build/octree_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "build/chunks.h"
#include "cdprep/advanced/parallel_for.h"
#include "core/numbers.h"

// The step. It must be at least 2 ulp of every plane. Then planes rise strictly, and no vertex more
// than a step inside is taken to be outside. The rounding of a plane moves it by at most half an
// ulp. An ulp is at most 2^-52 of its number. No plane is farther out than (1 + 2^-20) times the
// largest coordinate and twice the extent. So 2^-50 of that sum is enough. The cube: half the
// extent is at most 2^20 - 4 steps. Its middle and the origin are rounded by less than a step, so
// three steps stay free on every side.

namespace cdprep::build {
namespace {

constexpr int kStepBits = 32;

/// Returns the least number of kStepBits significant bits that is not below x > 0.
double rounded_up(double x) {
    assert(x > 0);
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);  // in [1/2, 1)
    const double up = std::ldexp(std::ceil(std::ldexp(fraction, kStepBits)), exponent - kStepBits);
    // For subnormal numbers the last step may round down.
    return up < x ? x : up;
}

/// The box around some points.
struct GridExtent {
    std::array<double, 3> lower = {kInfinity, kInfinity, kInfinity};
    std::array<double, 3> upper = {-kInfinity, -kInfinity, -kInfinity};

    void grow(const GridExtent& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], other.lower[axis]);
            upper[axis] = std::max(upper[axis], other.upper[axis]);
        }
    }
};

GridExtent grid_extent(std::span<const Double3> positions) {
    std::array<GridExtent, 2> every_other;  // two, so that neither waits for the other
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Double3& p = positions[i];
        every_other[i % 2].grow({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
    }
    every_other[0].grow(every_other[1]);
    return every_other[0];
}

GridExtent grid_extent(std::span<const Double3> positions, ParallelFor parallel_for) {
    if (positions.empty()) return {{0, 0, 0}, {0, 0, 0}};
    constexpr std::size_t kMostParts = 64;
    std::array<GridExtent, kMostParts> parts;
    const std::size_t size =
        std::max(kItemsPerTask, (positions.size() + kMostParts - 1) / kMostParts);
    for_chunks(positions.size(), size, parallel_for, [&](std::size_t first, std::size_t last) {
        parts[first / size] = grid_extent(positions.subspan(first, last - first));
    });
    for (std::size_t i = 1; i < kMostParts; ++i) parts[0].grow(parts[i]);
    return parts[0];
}

format::OctreeGrid grid_around(const GridExtent& extent) {
    double widest = 0;
    double farthest = 0;
    std::array<double, 3> middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lower = extent.lower[axis];
        const double upper = extent.upper[axis];
        widest = std::max(widest, upper - lower);
        farthest = std::max({farthest, std::fabs(lower), std::fabs(upper)});
        middle[axis] = lower + (upper - lower) / 2;
    }
    constexpr double kLeastStep = 0x1p-1072;  // the numbers are 2^-1074 apart there
    double step = rounded_up(
        std::max({widest / (kOctreeSteps - 8), 0x1p-50 * (farthest + 2 * widest), kLeastStep}));
    // A subnormal quotient may be too small by more than the free steps.
    while (step * (kOctreeSteps - 8) < widest) step = rounded_up(std::nextafter(step, kInfinity));
    const double half = step * (0.5 * kOctreeSteps);
    format::OctreeGrid grid{};
    grid.origin = {middle[0] - half, middle[1] - half, middle[2] - half};
    grid.step = step;
    return grid;
}

}  // namespace

format::OctreeGrid octree_grid_around(std::span<const Double3> positions,
                                      ParallelFor parallel_for) {
    return grid_around(grid_extent(positions, parallel_for));
}

}  // namespace cdprep::build
