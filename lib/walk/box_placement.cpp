// SPDX-License-Identifier: MIT
#include "walk/box_placement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/uncorrected_relative_pose.h"
#include "exact/length_of.h"

// Box tests run in float in the frame of A's boxes. If B is the larger model, the frame is scaled
// down further. So all boxes lie within [-1, 1], and nothing overflows for any extents. The slack
// that covers all rounding has two parts.
//
// Double, in model units. Let u = 2^-53, rho the largest |coordinate| of a model and |T| the
// largest |component| of its translation. Moved vertices have level E1. On either side, they are
// off their ideal places by at most 5 u (3 rho + |T|) per axis. The rotation into A's axes
// multiplies this by at most sqrt 3. R^T R is the identity only to 1e-12. So the rotation also
// shifts a point of A by up to 3e-12 rho if A moves. The relative pose itself is rounded by at most
// 16 u (|Ta| + |Tb| + 3 rho_b + rho_a). The shift and the places of leaves are computed from it,
// which adds 16 u of the same. The sum is below kDoubleSlack (rho_a + rho_b + |Ta| + |Tb|) +
// 4e-12 rho_a.
//
// Float, in frame units, v = 2^-24. Let boxes of A lie within s_a and boxes of B within s_b of
// their origins. Let t be the shift. Rotating a centre costs at most 9 v s_b, and adding the shift
// 2 v (s_b + |t|). Centres and half extents from lower and upper cost 2 v (s_a + s_b). The
// difference and the sums cost 4 v (s_a + 2 s_b + |t|). Along B's axes the same holds with a and b
// exchanged. The sum is below 32 v (s_a + s_b + |t|).
//
// Oriented boxes. The difference of two centres is off as above. Its product with a unit axis is
// off by 5 v sqrt 3 of it. So the same bound holds. Stored axes are not quite at right angles; the
// builder of these boxes covers that.

namespace cdprep {
namespace {

constexpr double kDoubleSlack = 96 * 0x1p-53;
constexpr double kTurnSlack = 4 * Pose::kRotationTolerance;
constexpr double kFloatSlack = 32 * 0x1p-24;

double largest(const Double3& p) noexcept {
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// Returns the largest |coordinate| that a vertex of the model can have.
double reach(const Double3& frame_origin, std::int32_t frame_exponent) noexcept {
    return largest(frame_origin) + two_to(-frame_exponent);
}
double reach(const format::FileHeader& header) noexcept {
    return reach(header.frame_origin, header.frame_exponent);
}

Double3 rotated(const std::array<double, 9>& r, const Double3& p) noexcept {
    return {r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
            r[6] * p.x + r[7] * p.y + r[8] * p.z};
}

/// Returns a float not below x. Requires that x is a normal number of float.
float float_above(double x) noexcept {
    return static_cast<float>(x * (1 + 0x1p-22));
}

}  // namespace

namespace {

double double_slack(const format::FileHeader& a, const format::FileHeader& b,
                    const Placement& placement) noexcept {
    const double reaches = reach(a) + reach(b) + largest(placement.pose_a().translation()) +
                           largest(placement.pose_b().translation());
    double slack = kDoubleSlack * reaches;
    if (placement.a_is_moved()) slack += kTurnSlack * reach(a);
    return slack;
}

}  // namespace

double double_slack(const Model& a, const Model& b, const Placement& placement) noexcept {
    return double_slack(a.header(), b.header(), placement);
}

PlacedBoxes place_boxes(const Model& a, const Model& b, const Placement& placement) noexcept {
    return place_boxes(a.header(), b.header(), placement);
}

PlacedBoxes place_boxes(const format::FileHeader& head_a, const format::FileHeader& head_b,
                        const Placement& placement) noexcept {
    const Pose a_from_b = placement.a_is_moved()
                              ? uncorrected_relative_pose(placement.pose_a(), placement.pose_b())
                              : placement.pose_b();
    const int exponent = std::min(head_a.frame_exponent, head_b.frame_exponent);
    const double scale_a = two_to(exponent - head_a.frame_exponent);
    const double scale_b = two_to(exponent - head_b.frame_exponent);

    const Double3 turned = rotated(a_from_b.rotation(), head_b.frame_origin);
    const Double3& t = a_from_b.translation();
    const Double3 shift = {scaled((turned.x + t.x) - head_a.frame_origin.x, exponent),
                           scaled((turned.y + t.y) - head_a.frame_origin.y, exponent),
                           scaled((turned.z + t.z) - head_a.frame_origin.z, exponent)};

    const double vertex_slack = scaled(double_slack(head_a, head_b, placement), exponent);
    const double slack = vertex_slack + kFloatSlack * (scale_a + scale_b + largest(shift));

    PlacedBoxes placed{};
    // Two balls with radius sqrt 3 times the scale contain all boxes.
    placed.apart = largest(shift) > 1.7321 * (scale_a + scale_b) + slack;
    kernels::BoxPlacement& p = placed.placement;
    const std::array<double, 9>& r = a_from_b.rotation();
    for (std::size_t i = 0; i < 9; ++i) {
        p.rotation[i] = static_cast<float>(r[i]);
        p.abs_rotation[i] = std::fabs(p.rotation[i]);
    }
    const std::array<double, 3> along_a = {shift.x, shift.y, shift.z};
    for (std::size_t i = 0; i < 3; ++i) {
        p.shift[i] = static_cast<float>(along_a[i]);
        p.shift_in_b[i] =
            static_cast<float>(r[i] * shift.x + r[3 + i] * shift.y + r[6 + i] * shift.z);
    }
    p.scale_a = static_cast<float>(scale_a);
    p.scale_b = static_cast<float>(scale_b);
    p.slack = float_above(slack);
    placed.rotation = r;
    placed.shift = along_a;
    placed.scale_a = scale_a;
    placed.scale_b = scale_b;
    placed.exponent = exponent;
    placed.double_slack = vertex_slack;
    return placed;
}

float float_reach(double distance) noexcept {
    // Not float_above(): a tolerance may be too small for a normal number.
    return distance < kMostReach ? std::nextafter(static_cast<float>(distance), HUGE_VALF)
                                 : HUGE_VALF;
}

// Two balls with radius sqrt 3 times the scale contain all triangles, up to the slack.
Outlook outlook(const PlacedBoxes& placed, double tolerance) noexcept {
    constexpr double kRounding = 0x1p-40;
    const double limit = std::ldexp(tolerance, placed.exponent);
    const double between = length_of(placed.shift[0], placed.shift[1], placed.shift[2]);
    const double reach =
        1.7321 * (placed.scale_a + placed.scale_b) + 2 * double{placed.placement.slack};
    if (limit < (between - reach) * (1 - kRounding)) return Outlook::none;
    const bool is_all = std::isfinite(between) && limit >= (between + reach) * (1 + kRounding);
    return is_all ? Outlook::all : Outlook::some;
}

PlacedBoxes place_upon_itself(const Double3& frame_origin, std::int32_t frame_exponent) noexcept {
    PlacedBoxes placed{};
    kernels::BoxPlacement& p = placed.placement;
    for (const std::size_t i : {0, 4, 8}) {
        p.rotation[i] = p.abs_rotation[i] = 1;
        placed.rotation[i] = 1;
    }
    p.scale_a = p.scale_b = 1;
    placed.scale_a = placed.scale_b = 1;
    placed.exponent = frame_exponent;
    // No vertex moves; only the places of leaves are rounded.
    const double slack = kDoubleSlack * 2 * reach(frame_origin, frame_exponent);
    placed.double_slack = scaled(slack, frame_exponent);
    p.slack = float_above(kFloatSlack * 2);
    return placed;
}

}  // namespace cdprep
