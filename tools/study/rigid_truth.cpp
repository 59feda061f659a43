// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/rigid_truth.h"

#include <algorithm>
#include <cmath>

#include "cdprep/pairs.h"
#include "mesh/vectors.h"
#include "study/source_triangles.h"

namespace cdprep::study {
namespace {

using mesh::cross;
using mesh::dot;
using mesh::largest_of;
using mesh::minus;

constexpr double kUnit = 0x1p-53;

/// Returns the sum of the largest |x|, |y| and |z| in the model's box.
double reach_of(const Model& model) noexcept {
    if (model.record().bounds == nullptr) return 0;
    const format::Bounds& box = *model.record().bounds;
    return std::max(std::fabs(box.lower.x), std::fabs(box.upper.x)) +
           std::max(std::fabs(box.lower.y), std::fabs(box.upper.y)) +
           std::max(std::fabs(box.lower.z), std::fabs(box.upper.z));
}

/// Returns the side of the plane through a, b, c on which d lies. Returns 0 if it is not certain
/// for points with errors of up to `shift` along each axis.
int certain_side(const Double3& a, const Double3& b, const Double3& c, const Double3& d,
                 double shift) noexcept {
    const Double3 u = minus(a, d);
    const Double3 v = minus(b, d);
    const Double3 w = minus(c, d);
    const double volume = dot(u, cross(v, w));
    const double most = std::max({largest_of(u), largest_of(v), largest_of(w)}) + 2 * shift;
    // The error of each entry is 2 shift, in three rows of six products each. The rounding error of
    // the entries and the sum is below 32 units in the last place of most^3.
    const double doubt = 40 * shift * most * most + 64 * kUnit * most * most * most;
    if (std::fabs(volume) <= doubt) return 0;
    return volume > 0 ? 1 : -1;
}

/// Returns whether the segment certainly passes through the interior of the triangle.
bool pierces(const Double3& p, const Double3& q, const Corners& t, double shift) noexcept {
    const int from = certain_side(t[0], t[1], t[2], p, shift);
    const int to = certain_side(t[0], t[1], t[2], q, shift);
    if (from * to >= 0) return false;
    const int first = certain_side(p, q, t[0], t[1], shift);
    return first != 0 && certain_side(p, q, t[1], t[2], shift) == first &&
           certain_side(p, q, t[2], t[0], shift) == first;
}

bool pierces_any(const Corners& edges, const Corners& t, double shift) noexcept {
    return pierces(edges[0], edges[1], t, shift) || pierces(edges[1], edges[2], t, shift) ||
           pierces(edges[2], edges[0], t, shift);
}

}  // namespace

double rounding_of_pose(const Model& b, const Pose& a_from_b) noexcept {
    // The error of the entries of R is 8 units; their absolute values are at most 1.
    // transform_point() adds an error of 5 units of |R||v| + |t|. The sum is 13; 16 also covers
    // terms of second order.
    return 16 * kUnit * (reach_of(b) + largest_of(a_from_b.translation()));
}

bool is_apart_when_rigid(const Model& b, const Pose& a_from_b, double gap) noexcept {
    return gap > 2 * rounding_of_pose(b, a_from_b);  // 2 > sqrt(3), for three axes
}

bool crosses_when_rigid(const SourceTriangles& a, const SourceTriangles& b, const Pose& a_from_b,
                        Workspace& workspace) {
    const double shift = rounding_of_pose(b.model(), a_from_b);
    bool is_certain = false;
    const auto look_at = [&](const TrianglePair& pair) {
        const Corners of_a = a.corners(pair.a);
        const Corners of_b = b.corners(pair.b, a_from_b);
        is_certain = pierces_any(of_a, of_b, shift) || pierces_any(of_b, of_a, shift);
        return !is_certain;
    };
    visit_overlaps({a.model(), b.model(), Placement::b_moves(a_from_b)}, workspace, look_at);
    return is_certain;
}

}  // namespace cdprep::study
