// SPDX-License-Identifier: MIT
#include "cells/build/tetra_steps.h"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "build/chunks.h"
#include "build/frame_map.h"
#include "cdprep/advanced/parallel_for.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::Triangle;

struct Sum {
    std::array<double, 3> distance{};
    std::uint64_t count = 0;
};

using Marks = std::vector<std::uint8_t>;

/// Marks the vertices that triangles use.
Marks mark_used(std::size_t vertices, std::span<const Triangle> triangles,
                ParallelFor parallel_for) {
    Marks used(vertices);
    for_chunks(triangles.size(), kItemsPerTask, parallel_for,
               [&](std::size_t first, std::size_t last) {
                   for (std::size_t i = first; i < last; ++i) {
                       for (const std::uint32_t v : triangles[i].vertex) {
                           std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
                       }
                   }
               });
    return used;
}

/// Returns the sum of one task, in the vertices' order: the same for any number of threads.
Sum sum_of(std::span<const Double3> positions, const Marks& used, std::size_t first,
           std::size_t last, const Extent& extent, double scale) {
    Sum sum;
    for (std::size_t i = first; i < last; ++i) {
        if (used[i] == 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sum.distance[axis] += (coordinate(positions[i], axis) - extent.lower[axis]) * scale;
        }
        ++sum.count;
    }
    return sum;
}

Sum sum_all(std::span<const Double3> positions, const Marks& used, const Extent& extent,
            double scale, ParallelFor parallel_for) {
    std::vector<Sum> parts((positions.size() + kItemsPerTask - 1) / kItemsPerTask);
    for_chunks(
        positions.size(), kItemsPerTask, parallel_for, [&](std::size_t first, std::size_t last) {
            parts[first / kItemsPerTask] = sum_of(positions, used, first, last, extent, scale);
        });
    Sum all;
    for (const Sum& part : parts) {
        for (std::size_t axis = 0; axis < 3; ++axis) all.distance[axis] += part.distance[axis];
        all.count += part.count;
    }
    return all;
}

std::int32_t exponent_of(const Extent& extent) {
    double longest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        longest = std::max(longest, extent.upper[axis] - extent.lower[axis]);
    }
    constexpr int kMost = 1020;  // of a normal double
    return longest > 0 ? std::clamp(-std::ilogb(longest), -kMost, kMost) : 0;
}

}  // namespace

TetraCentre tetra_centre(std::span<const Double3> positions, std::span<const Triangle> triangles,
                         ParallelFor parallel_for) {
    const Marks used = mark_used(positions.size(), triangles, parallel_for);
    const Extent extent = extent_of(positions, used, parallel_for);
    const std::int32_t exponent = exponent_of(extent);
    const Sum sum = sum_all(positions, used, extent, std::ldexp(1.0, exponent), parallel_for);
    std::array<double, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        assert(sum.count > 0);
        const double mean = sum.distance[axis] / static_cast<double>(sum.count);
        double x = extent.lower[axis] + std::ldexp(mean, -exponent);
        if (extent.floats) x = static_cast<float>(x);
        at[axis] = std::clamp(x, extent.lower[axis], extent.upper[axis]);
    }
    return {{at[0], at[1], at[2]}, exponent};
}

}  // namespace cdprep::build
