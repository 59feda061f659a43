// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/fan.h"
#include "mesh/vectors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

// Take any direction d. Projected along d, a triangle of the star is a sector of the plane
// between two rays. Let all sectors turn counter-clockwise, det(d, ray, next ray) > 0. Let each
// ray except the first and last end one sector and begin another. Then the number of sectors
// that cover a point changes only at the first and last ray. So it suffices to count at one ray.
// The sectors that pass a ray r, or arrive at it, are those with det(d, r, ray) < 0 <= det(d, r,
// next ray). A closed fan is simple if the count is one; an open fan, if it is zero at its first
// ray. Cones with disjoint sectors meet only in the vertex. Neighbours meet only above their
// common ray, that is in their common edge.
//
// All signs must be certain. Let u = 2^-53. Let d be the computed direction (any will do). Let p
// and q be the largest components of two edge vectors. These are rounded differences (u). A
// component of a normal is at most 2 p q, with an error of 10 u p q. The products with d and
// their sums add 3 u of the terms. The total is below 20 u p q (|dx| + |dy| + |dz|). The same
// bound holds for (d x r) . s, whose terms are those of d . (r x s). Underflow changes a product
// by 2^-1075, which d, below 1e110, cannot carry beyond 1e-213.

namespace cdprep::mesh {
namespace {

constexpr double kOff = 32 * 0x1p-53;
constexpr double kLargestWay = 1e50;
constexpr double kLeastBound = 1e-200;

constexpr std::array<std::size_t, 3> kNextCorner = {1, 2, 0};

/// Returns whether the size of a value proves its sign; `product` is that of the two edge
/// vectors.
bool is_certain(double value, double product, double direction) {
    const double bound = kOff * direction * product;
    return bound > kLeastBound && std::fabs(value) > bound;
}

}  // namespace

bool Fan::lies_side_by_side(const Mesh& mesh, std::uint32_t vertex,
                            std::span<const std::uint32_t> star) {
    if (star.size() < 2) return true;
    find_rays(mesh, vertex, star);
    return (count_ <= kFew ? chain_few() : chain_many()) && look(mesh, vertex) && is_simple();
}

void Fan::find_rays(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star) {
    count_ = star.size();
    if (from_.size() <= count_) {
        const std::size_t room = std::max(2 * count_, 2 * kFew);
        from_.resize(room);
        to_.resize(room);
        next_.resize(room);
        way_.resize(room);
        far_.resize(room);
        normal_.resize(room);
        before_.resize(room);
    }
    for (std::size_t i = 0; i < count_; ++i) {
        const auto& v = mesh.triangles[star[i]].vertex;
        // The index is unpredictable, so it is computed without a branch.
        const std::size_t corner = (v[1] == vertex ? 1U : 0U) | (v[2] == vertex ? 2U : 0U);
        from_[i] = v[kNextCorner[corner]];
        to_[i] = v[kNextCorner[kNextCorner[corner]]];
    }
}

bool Fan::chain_few() {
    std::uint32_t continued = 0;
    std::size_t ends = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        std::uint32_t follow = 0;
        for (std::uint32_t j = 0; j < kFew; ++j) follow |= from_[j] == to_[i] ? 1U << j : 0U;
        follow &= (1U << count_) - 1;
        if ((follow & (follow - 1)) != 0 || (continued & follow) != 0) return false;
        continued |= follow;
        if (follow == 0) {
            ++ends;
            next_[i] = static_cast<std::uint32_t>(count_);
            from_[count_] = to_[i];
        } else {
            next_[i] = static_cast<std::uint32_t>(std::countr_zero(follow));
        }
    }
    is_open_ = ends == 1;
    first_ = is_open_ ? static_cast<std::size_t>(std::countr_one(continued)) : 0;
    return ends <= 1;
}

bool Fan::chain_many() {
    order_.resize(count_);
    std::iota(order_.begin(), order_.end(), 0U);
    const auto by_ray = [&](std::uint32_t i, std::uint32_t j) { return from_[i] < from_[j]; };
    std::sort(order_.begin(), order_.end(), by_ray);
    const auto same_ray = [&](std::uint32_t i, std::uint32_t j) { return from_[i] == from_[j]; };
    if (std::adjacent_find(order_.begin(), order_.end(), same_ray) != order_.end()) return false;
    std::fill_n(before_.begin(), count_, std::uint8_t{0});
    std::size_t ends = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const auto at =
            std::lower_bound(order_.begin(), order_.end(), to_[i],
                             [&](std::uint32_t j, std::uint32_t ray) { return from_[j] < ray; });
        if (at == order_.end() || from_[*at] != to_[i]) {
            ++ends;
            next_[i] = static_cast<std::uint32_t>(count_);
            from_[count_] = to_[i];
            continue;
        }
        if (before_[*at] != 0) return false;
        before_[*at] = 1;
        next_[i] = *at;
    }
    is_open_ = ends == 1;
    const auto unreached = std::find(before_.begin(), before_.end(), std::uint8_t{0});
    first_ = is_open_ ? static_cast<std::size_t>(unreached - before_.begin()) : 0;
    return ends <= 1;
}

bool Fan::look(const Mesh& mesh, std::uint32_t vertex) {
    const Double3& at = mesh.positions[vertex];
    for (std::size_t i = 0; i < rays(); ++i) {
        way_[i] = minus(mesh.positions[from_[i]], at);
        far_[i] = largest_of(way_[i]);
        if (far_[i] > kLargestWay) return false;
    }
    along_ = {0, 0, 0};
    for (std::size_t i = 0; i < count_; ++i) {
        const Double3 normal = cross(way_[i], way_[next_[i]]);
        normal_[i] = normal;
        along_ = {along_.x + normal.x, along_.y + normal.y, along_.z + normal.z};
    }
    size_ = std::fabs(along_.x) + std::fabs(along_.y) + std::fabs(along_.z);
    bool all_turn = true;
    for (std::size_t i = 0; i < count_; ++i) {
        const double turn = dot(along_, normal_[i]);
        all_turn &= turn > 0 && is_certain(turn, far_[i] * far_[next_[i]], size_);
    }
    return all_turn;
}

bool Fan::is_simple() {
    const Double3 across = cross(along_, way_[first_]);
    for (std::size_t i = 0; i < rays(); ++i) {
        const double side = dot(across, way_[i]);
        before_[i] = i != first_ && side < 0 ? 1 : 0;
        if (i != first_ && !is_certain(side, far_[first_] * far_[i], size_)) return false;
    }
    std::size_t passing = 0;
    for (std::size_t i = 0; i < count_; ++i) passing += before_[i] & ~before_[next_[i]] & 1U;
    return passing == (is_open_ ? 0U : 1U);
}

}  // namespace cdprep::mesh
