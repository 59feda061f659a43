// SPDX-License-Identifier: MIT
// A leaf of triangles whose coordinates are floats. Included by kernel sources alone. Each number
// is rounded as where leaves are made without a kernel (build/make_leaves.cpp). So what is stored
// is the same for every table.
#pragma once

#include "kernels.h"

namespace cdprep::kernels {
namespace {

/// Loads the points of eight numbers, three numbers apart: a row for each coordinate. This and the
/// next have other forms for some instruction sets.
template <class F>
void load_points(const float* positions, const std::uint32_t* vertices, F (&row)[3]) noexcept {
    alignas(32) float coordinate[3][kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float* from = positions + std::size_t{3} * vertices[3 * lane];
        for (std::size_t axis = 0; axis < 3; ++axis) coordinate[axis][lane] = from[axis];
    }
    for (std::size_t axis = 0; axis < 3; ++axis) row[axis] = F::load(coordinate[axis]);
}

/// Reduces eight rows to the least lane of each. Of zeros with both signs, chooses as
/// build::least().
template <class F>
F least_of_rows(const F (&row)[kLanes]) noexcept {
    alignas(32) float least[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) {
        alignas(32) float half[kLanes];
        min(halves_exchanged(row[i]), row[i]).store(half);
        const float even = half[2] < half[0] ? half[2] : half[0];
        const float odd = half[3] < half[1] ? half[3] : half[1];
        least[i] = odd < even ? odd : even;
    }
    return F::load(least);
}

/// Returns the lanes whose corners are proven not to be collinear: the coordinate `axis` of their
/// normal is not 0. Let u = 2^-24. The differences, the products and their difference round by less
/// than 5 u of the products' magnitudes. Underflow moves the products by less than 2^-148. Where
/// numbers overflow, nothing is proven.
template <class F>
unsigned lanes_with_area(const F (&corner)[3][3], std::size_t axis) noexcept {
    const F rounding(0x1p-21F), least(0x1p-140F);
    const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
    const F first = (corner[1][x] - corner[0][x]) * (corner[2][y] - corner[0][y]);
    const F second = (corner[1][y] - corner[0][y]) * (corner[2][x] - corner[0][x]);
    const F error = fma(abs(first) + abs(second), rounding, least);
    return bits(greater(abs(first - second), error));
}

/// Returns the least floats that are at least x, as build::float_above(). Let r be the nearest
/// float, r < x, and r + e the next one. More than e / 2 and less than 3 e / 2 is added to r. So
/// the sum rounds to r + e. For e is from |r| 2^-24 to |r| 2^-23 or, of subnormal numbers, 2^-149.
template <class D>
auto floats_above(const D& x) noexcept {
    const D nearest = doubles_of(floats_of(x));
    const D step = max(abs(nearest) * D(0x1p-24), D(0x1p-150)) * D(1 + 0x1p-20);
    const D next = doubles_of(floats_of(nearest + step));
    return floats_of(select(greater(x, nearest), next, nearest));
}

/// Maps doubles to the frame of a tree and moves them outwards, as build::FrameMap::around() does.
/// The signs of the lanes are -1 for lower bounds and 1 for upper ones.
template <class D>
auto bounds_in_frame(const LeafMap& map, const D& x, const D& sign) noexcept {
    const D origin = D::load(map.origin);
    const D difference = x - origin;
    const D virtual_origin = x - difference;
    const D virtual_x = difference + virtual_origin;
    const D tail = (x - virtual_x) + (virtual_origin - origin);
    const D at = difference * D(map.scale[0]) * D(map.scale[1]);
    const D lost = at * D(map.back[0]) * D(map.back[1]) - difference;
    const D slack =
        select(greater(abs(tail) + abs(lost), D(0.0)), abs(at) * D(0x1p-51) + D(0x1p-1000), D(0.0));
    return floats_above((at + sign * slack) * sign);
}

/// The body of fill_leaf().
template <class F, class D>
unsigned fill_leaf_of(const LeafMap& map, const float* positions, const std::uint32_t* vertices,
                      float* leaf, float* box) noexcept {
    F corner[3][3];
    for (std::size_t k = 0; k < 3; ++k) {
        load_points(positions, vertices + k, corner[k]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corner[k][axis].store(leaf + (3 * k + axis) * kLanes);
        }
    }
    F bound[kPaddedBox];
    bound[3] = bound[7] = F(0.0F);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        F lower = corner[0][axis], upper = lower;
        for (std::size_t k = 1; k < 3; ++k) {
            lower = min(corner[k][axis], lower);
            upper = max(corner[k][axis], upper);
        }
        bound[axis] = lower;
        bound[axis + kPaddedUpper] = -upper;
    }
    static constexpr float kSigns[kPaddedBox] = {-1, -1, -1, -1, 1, 1, 1, 1};
    const F sign = F::load(kSigns);
    const F around = least_of_rows(bound) * -sign;
    const D lower = doubles_of(around), upper = doubles_of(halves_exchanged(around));
    (bounds_in_frame(map, lower, doubles_of(sign)) * sign).store(box);

    // Below, the first three lanes have a meaning.
    const F middle = floats_of(lower * D(0.5) + upper * D(0.5));
    const D origin = doubles_of(middle);
    // The difference of two doubles is off by at most half an ulp.
    const D reach = max(upper - origin, origin - lower) * D(1 + 0x1p-50);
    const F half = floats_above(reach * D(map.scale[0]) * D(map.scale[1]));
    alignas(32) float middles[kLanes], halves[kLanes];
    middle.store(middles);
    half.store(halves);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        leaf[kLeafOrigin + axis] = middles[axis];
        leaf[kLeafHalf + axis] = halves[axis];
    }

    unsigned lanes = lanes_with_area(corner, 0);
    for (std::size_t axis = 1; axis < 3 && lanes != 0xff; ++axis) {
        lanes |= lanes_with_area(corner, axis);
    }
    return lanes;
}

}  // namespace
}  // namespace cdprep::kernels
