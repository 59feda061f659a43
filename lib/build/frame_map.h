// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/format/api.h"
#include "cdprep/format/portable.h"
#include "exact/powers_of_two.h"

namespace cdprep::build {

[[nodiscard]] inline double coordinate(const format::Double3& p, std::size_t axis) {
    assert(axis < 3);
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

[[nodiscard]] inline format::Double3 as_double(const format::Double3& p) {
    return p;
}
[[nodiscard]] inline format::Double3 as_double(const format::Float3& p) {
    return {double{p.x}, double{p.y}, double{p.z}};
}

/// Returns the least float that is at least x. Requires a finite x in the range of float.
[[nodiscard]] inline float float_above(double x) {
    const auto rounded = static_cast<float>(x);
    const float zero_is_positive = rounded + 0.0F;
    const auto bits = format::bit_cast<std::int32_t>(zero_is_positive);
    const std::int32_t away = bits < 0 ? -1 : 1;
    return double{rounded} < x ? format::bit_cast<float>(bits + away) : rounded;
}

[[nodiscard]] inline float float_below(double x) {
    return -float_above(-x);
}

/// The properties of all vertices that triangles use: their bounds, and whether all are floats.
struct Extent {
    std::array<double, 3> lower;
    std::array<double, 3> upper;
    bool floats;  ///< every coordinate is a float
};

[[nodiscard]] CDPREP_API Extent extent_of(std::span<const format::Double3> positions,
                                          std::span<const format::Triangle> triangles,
                                          ParallelFor parallel_for);

/// As above, for the vertices whose mark is not 0.
[[nodiscard]] CDPREP_API Extent extent_of(std::span<const format::Double3> positions,
                                          std::span<const std::uint8_t> marks,
                                          ParallelFor parallel_for);

/// As above, for all vertices.
[[nodiscard]] Extent extent_of(std::span<const format::Double3> positions,
                               ParallelFor parallel_for);
[[nodiscard]] Extent extent_of(std::span<const format::Float3> positions, ParallelFor parallel_for);

/// Centres the box and scales it by a power of two so that no coordinate leaves [-1, 1], not even
/// after rounding. The largest distance lies in [1/4, 1/2].
[[nodiscard]] Frame frame_of(const Extent& extent);

/// Returns whether leaves keep model coordinates: all are floats, and the scale of the frame is an
/// ordinary float.
[[nodiscard]] bool has_exact_leaves(bool are_floats, const Frame& frame);

/// A frame coordinate between two floats.
struct Interval {
    float lower;
    float upper;
};

/// Maps model coordinates to frame coordinates.
class FrameMap {
public:
    explicit FrameMap(const Frame& frame)
        : origin_{frame.origin.x, frame.origin.y, frame.origin.z},
          scale_(frame.exponent),
          back_(-frame.exponent) {}

    /// Returns a length in frame units. Rounds only below the normal range.
    [[nodiscard]] double scaled(double length) const {
        return scale_(length);
    }

    /// Returns the frame coordinate of x, rounded at most twice.
    [[nodiscard]] double near(double x, std::size_t axis) const {
        return scaled(x - origin_[axis]);
    }

    /// Returns floats around the frame coordinate of x. The difference rounds by at most half an
    /// ulp, and the scaling rounds only below the normal range. Both are detected; the double is
    /// then widened before it becomes a float.
    [[nodiscard]] Interval around(double x, std::size_t axis) const {
        const double origin = origin_[axis];
        const double difference = x - origin;
        const double virtual_origin = x - difference;
        const double virtual_x = difference + virtual_origin;
        const double tail = (x - virtual_x) + (virtual_origin - origin);
        const double at = scaled(difference);
        const bool rounded = tail != 0 || back_(at) != difference;
        constexpr double kBelowEveryFloat = 0x1p-1000;
        const double slack = rounded ? std::fabs(at) * 0x1p-51 + kBelowEveryFloat : 0;
        return {float_below(at - slack), float_above(at + slack)};
    }

private:
    std::array<double, 3> origin_;
    Scale scale_;
    Scale back_;
};

}  // namespace cdprep::build
