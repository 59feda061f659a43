// SPDX-License-Identifier: MIT
#include "build/frame_map.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

#include "build/chunks.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/portable.h"
#include "core/numbers.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::Float3;
using format::Triangle;

/// The largest |exponent| of frames whose scale is an ordinary float.
constexpr std::int32_t kMaxExactExponent = 100;

struct PointBounds {
    std::array<double, 3> lower = {kInfinity, kInfinity, kInfinity};
    std::array<double, 3> upper = {-kInfinity, -kInfinity, -kInfinity};
    std::uint64_t lost = 0;  ///< bits that rounding to float changes

    void grow(const PointBounds& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], other.lower[axis]);
            upper[axis] = std::max(upper[axis], other.upper[axis]);
        }
        lost |= other.lost;
    }
    void grow(const Double3& p) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = coordinate(p, axis);
            lower[axis] = std::min(lower[axis], x);
            upper[axis] = std::max(upper[axis], x);
            lost |= format::bit_cast<std::uint64_t>(x) ^
                    format::bit_cast<std::uint64_t>(double{static_cast<float>(x)});
        }
    }
};

/// Returns the union of part(first, last) over all parts of `count` items.
template <class Part>
Extent extent_of_parts(std::size_t count, ParallelFor parallel_for, const Part& part) {
    constexpr std::size_t kMostParts = 64;
    std::array<PointBounds, kMostParts> parts;
    const std::size_t size = std::max(kItemsPerTask, (count + kMostParts - 1) / kMostParts);
    for_chunks(count, size, parallel_for, [&](std::size_t first, std::size_t last) {
        parts[first / size] = part(first, last);
    });
    for (std::size_t i = 1; i < kMostParts; ++i) parts[0].grow(parts[i]);
    const auto& [lower, upper, lost] = parts[0];
    return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}, lost == 0};
}

template <class Position>
Extent extent_of_all(std::span<const Position> positions, ParallelFor parallel_for) {
    const auto part = [&](std::size_t first, std::size_t last) {
        PointBounds bounds;
        for (std::size_t i = first; i < last; ++i) bounds.grow(as_double(positions[i]));
        return bounds;
    };
    return extent_of_parts(positions.size(), parallel_for, part);
}

}  // namespace

Extent extent_of(std::span<const Double3> positions, std::span<const Triangle> triangles,
                 ParallelFor parallel_for) {
    const auto part = [&](std::size_t first, std::size_t last) {
        // One for each corner, so that none waits for another.
        std::array<PointBounds, 3> corner;
        for (std::size_t i = first; i < last; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                corner[k].grow(positions[triangles[i].vertex[k]]);
            }
        }
        corner[0].grow(corner[1]);
        corner[0].grow(corner[2]);
        return corner[0];
    };
    return extent_of_parts(triangles.size(), parallel_for, part);
}

Extent extent_of(std::span<const Double3> positions, std::span<const std::uint8_t> marks,
                 ParallelFor parallel_for) {
    assert(marks.size() == positions.size());
    const auto part = [&](std::size_t first, std::size_t last) {
        PointBounds bounds;
        for (std::size_t i = first; i < last; ++i) {
            if (marks[i] != 0) bounds.grow(positions[i]);
        }
        return bounds;
    };
    return extent_of_parts(positions.size(), parallel_for, part);
}

Extent extent_of(std::span<const Double3> positions, ParallelFor parallel_for) {
    return extent_of_all(positions, parallel_for);
}

Extent extent_of(std::span<const Float3> positions, ParallelFor parallel_for) {
    return extent_of_all(positions, parallel_for);
}

bool has_exact_leaves(bool are_floats, const Frame& frame) {
    return are_floats && std::abs(frame.exponent) <= kMaxExactExponent;
}

Frame frame_of(const Extent& extent) {
    std::array<double, 3> origin{};
    double reach = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        origin[axis] = 0.5 * extent.lower[axis] + 0.5 * extent.upper[axis];
        reach =
            std::max({reach, extent.upper[axis] - origin[axis], origin[axis] - extent.lower[axis]});
    }
    Frame frame{{origin[0], origin[1], origin[2]}, 0};
    if (reach > 0) {
        int exponent = 0;
        std::frexp(reach, &exponent);
        frame.exponent = -exponent - 1;
    }
    return frame;
}

}  // namespace cdprep::build
