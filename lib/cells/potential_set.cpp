// SPDX-License-Identifier: MIT
#include "cells/potential_set.h"

#include <algorithm>
#include <cmath>

#include "walk/box_placement.h"

// The slack. A direction has components of at most 1. A vertex of B and a point of A that
// the query finds to be one are double_slack() apart, per axis, where the ideal motion puts
// them: 3 of it along a direction. That is at least 96 u (rho_a + rho_b + |Ta| + |Tb|),
// u = 2^-53; turning a direction into B's axes, the products with a corner and the offset
// are off by less than 24 u of the same sum times 3: one more, and a box's corner is three
// times as far out as its coordinates: another.

namespace cdprep {
namespace {

constexpr double kSlacks = 6;
/// Where numbers are subnormal, products are off by this much more, whatever their size.
constexpr double kUnderflow = 0x1p-1066;

double dot(const Double3& a, const Double3& b) noexcept {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// The box that A's triangles lie in.
struct OrientedBox {
    std::array<Double3, 3> axis;
    Double3 centre;
    std::array<double, 3> half;
};

OrientedBox box_of(const Model& model) noexcept {
    if (const format::Bounds* bounds = model.record().bounds) {
        const Double3& half = bounds->half_extent;
        return {bounds->axis, bounds->oriented_centre, {half.x, half.y, half.z}};
    }
    const format::FileHeader& header = model.header();
    const double half = two_to(-header.frame_exponent);
    return {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, header.frame_origin, {half, half, half}};
}

}  // namespace

PotentialSet::PotentialSet(const Model& a, const Model& b, const Placement& placement) noexcept {
    const Pose a_from_b = placement.a_is_moved()
                              ? relative_pose(placement.pose_a(), placement.pose_b())
                              : placement.pose_b();
    const std::array<double, 9>& r = a_from_b.rotation();
    const Double3& t = a_from_b.translation();
    const double slack = kSlacks * double_slack(a, b, placement) + kUnderflow;
    const OrientedBox box = box_of(a);
    const format::FileHeader& frame = b.header();
    const Double3& o = frame.frame_origin;
    for (std::size_t k = 0; k < 3; ++k) {
        const Double3& axis = box.axis[k];
        Slab& slab = slab_[k];
        for (std::size_t i = 0; i < 3; ++i) {
            slab.normal[i] = (axis.x * r[i] + axis.y * r[3 + i]) + axis.z * r[6 + i];
        }
        slab.offset = dot(axis, {t.x - box.centre.x, t.y - box.centre.y, t.z - box.centre.z});
        slab.limit = box.half[k] + slack;
        const Double3 normal = {slab.normal[0], slab.normal[1], slab.normal[2]};
        slab.node_offset = scaled(dot(normal, o) + slab.offset, frame.frame_exponent);
        slab.node_limit = scaled(slab.limit, frame.frame_exponent);
    }
    if (b.record().bounds != nullptr) {
        is_empty_ = std::any_of(slab_.begin(), slab_.end(),
                                [&](const Slab& slab) { return clips(slab, *b.record().bounds); });
    }
}

bool PotentialSet::clips(const Slab& slab, const format::Bounds& box) noexcept {
    const Double3 normal = {slab.normal[0], slab.normal[1], slab.normal[2]};
    const Double3& half = box.half_extent;
    const double reach = std::fabs(dot(normal, box.axis[0])) * half.x +
                         std::fabs(dot(normal, box.axis[1])) * half.y +
                         std::fabs(dot(normal, box.axis[2])) * half.z;
    return std::fabs(dot(normal, box.oriented_centre) + slab.offset) > slab.limit + reach;
}

BoxVerdict PotentialSet::judge(const format::BvhNode& node) const noexcept {
    BoxVerdict verdict;
    for (std::uint32_t j = 0; j < format::kBvhWidth; ++j) {
        bool clipped = false;
        for (const Slab& slab : slab_) {
            double at = slab.node_offset;
            double reach = slab.node_limit;
            for (std::size_t i = 0; i < 3; ++i) {
                const double lower = node.lower[i][j];
                const double upper = node.upper[i][j];
                at += slab.normal[i] * (0.5 * (lower + upper));
                reach += std::fabs(slab.normal[i]) * (0.5 * (upper - lower));
            }
            clipped |= std::fabs(at) > reach;
        }
        verdict.near |= static_cast<unsigned>(!clipped) << j;
    }
    return verdict;
}

bool PotentialSet::holds(const Corners& t) const noexcept {
    for (const Slab& slab : slab_) {
        const Double3 normal = {slab.normal[0], slab.normal[1], slab.normal[2]};
        const std::array<double, 3> at = {dot(normal, t[0]) + slab.offset,
                                          dot(normal, t[1]) + slab.offset,
                                          dot(normal, t[2]) + slab.offset};
        if (std::min({at[0], at[1], at[2]}) > slab.limit) return false;
        if (std::max({at[0], at[1], at[2]}) < -slab.limit) return false;
    }
    return true;
}

}  // namespace cdprep
