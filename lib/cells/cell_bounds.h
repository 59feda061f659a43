// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/octree.h"
#include "exact/powers_of_two.h"
#include "walk/box_placement.h"

namespace cdprep {

/// The bounds of eight cells side by side, in frame coordinates, as the kernels read them.
struct MadeBounds {
    format::BvhNode boxes;
    format::OrientedNode oriented;  ///< set by trees with kOriented
};

/// The same from a file. The second pointer, or both, may be null.
struct StoredBounds {
    const format::BvhNode* boxes = nullptr;
    const format::OrientedNode* oriented = nullptr;
};

/// The boxes of eight cells side by side, wherever they are stored.
struct CellBounds {
    const format::BvhNode& boxes;
};

/// The bounds of the children of the cells that a walk visited last.
struct KeptBounds {
    static constexpr std::size_t kPlaces = 32;

    struct Place {
        std::uint64_t holds;  ///< query and node
        unsigned leaf_lanes;  ///< the children that are leaves
        MadeBounds bounds;
    };
    // Lanes without a child hold earlier values or zeros. Subnormal numbers would slow the kernels
    // down.
    std::array<Place, kPlaces> place{};
    std::uint64_t question = 0;
};

/// The map from model coordinates to a model's frame.
class FrameOf {
public:
    explicit FrameOf(const Model& model) noexcept
        : origin_{model.header().frame_origin.x, model.header().frame_origin.y,
                  model.header().frame_origin.z},
          scale_(model.header().frame_exponent) {}

    /// Returns a frame coordinate in double, off by at most 2^-53 of itself.
    [[nodiscard]] double frame(std::size_t axis, double x) const noexcept {
        return scale_(x - origin_[axis]);
    }

private:
    std::array<double, 3> origin_;
    Scale scale_;
};

/// Rounds a number outwards to float. The number may be off by 2^-52 of itself and by 2^-46 (frame
/// units: nothing in a file is finer than float there). Float rounds by 2^-24 of it; twice that
/// covers all errors.
inline float float_below(double x) noexcept {
    return static_cast<float>(x - (std::fabs(x) * 0x1p-23 + 0x1p-45));
}
inline float float_over(double x) noexcept {
    return static_cast<float>(x + (std::fabs(x) * 0x1p-23 + 0x1p-45));
}

/// Clips to the frame. Everything of a model lies in it, so the part of a box outside is empty.
inline float clipped(float x) noexcept {
    return std::clamp(x, -1.0F, 1.0F);
}

/// One axis of a node: its box from `lower` to `upper`, and the plane that divides it.
struct DividedAxis {
    double lower;
    double middle;
    double upper;
};

/// Sets the boxes of the eight children of a box, in frame coordinates. Lanes are numbered as in
/// octree.h.
inline void bound_octants(std::size_t axis, const DividedAxis& planes,
                          format::BvhNode& boxes) noexcept {
    assert(axis < 3);
    const std::array<float, 2> lower = {clipped(float_below(planes.lower)),
                                        clipped(float_below(planes.middle))};
    const std::array<float, 2> upper = {clipped(float_over(planes.middle)),
                                        clipped(float_over(planes.upper))};
    for (std::size_t lane = 0; lane < format::kBvhWidth; ++lane) {
        boxes.lower[axis][lane] = lower[lane >> axis & 1];
        boxes.upper[axis][lane] = upper[lane >> axis & 1];
    }
}

/// Copies the stored boxes of children, side by side from `first` on, to their lanes.
inline void bound_by_boxes(const format::CellBox* first, unsigned lanes,
                           format::BvhNode& boxes) noexcept {
    assert(lanes <= 0xff);
    for (; lanes != 0; lanes &= lanes - 1, ++first) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            boxes.lower[axis][lane] = first->lower[axis];
            boxes.upper[axis][lane] = first->upper[axis];
        }
    }
}

/// Sets the box of a root in lane 0. The other lanes repeat it.
inline void bound_root(std::size_t axis, double lower, double upper,
                       format::BvhNode& boxes) noexcept {
    boxes.lower[axis].fill(clipped(float_below(lower)));
    boxes.upper[axis].fill(clipped(float_over(upper)));
}

/// The node number of the cell above the roots of a tree.
inline constexpr std::uint32_t kAboveRoots = 0xffffffff;

/// Returns the number of set bits of eight. std::popcount() is a call without the instruction,
/// which not every processor has.
inline std::uint32_t bits_in(unsigned lanes) noexcept {
    assert(lanes <= 0xff);
    lanes -= lanes >> 1 & 0x55;
    lanes = (lanes & 0x33) + (lanes >> 2 & 0x33);
    return (lanes + (lanes >> 4)) & 0xf;
}

/// Returns the number of set lanes below `lane`: the place of a child among its siblings.
inline std::uint32_t lanes_before(unsigned lanes, unsigned lane) noexcept {
    assert(lane < format::kBvhWidth);
    return bits_in(lanes & ((1U << lane) - 1));
}

/// Returns all pairs of some lanes of A and some of B.
inline kernels::BoxPairs lane_pairs(unsigned of_a, unsigned of_b) noexcept {
    assert(of_a <= 0xff && of_b <= 0xff);
    kernels::BoxPairs pairs = 0;
    for (; of_b != 0; of_b &= of_b - 1) {
        pairs |= kernels::BoxPairs{of_a} << (8 * std::countr_zero(of_b));
    }
    return pairs;
}

}  // namespace cdprep
