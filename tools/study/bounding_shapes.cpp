// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/bounding_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "convex/find_bounds.h"
#include "mesh/vectors.h"

namespace cdprep::study {
namespace {

constexpr int kSphereSteps = 100;

using mesh::cross;
using mesh::dot;
using mesh::minus;

double length(const Double3& a) {
    return std::hypot(a.x, a.y, a.z);
}

Double3 turned(const Pose& pose, const Double3& v) {
    const auto& r = pose.rotation();
    return {r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
            r[6] * v.x + r[7] * v.y + r[8] * v.z};
}

/// What lengths of a question about these are enlarged by.
double slack_of(const Double3& centre_a, double size_a, const Double3& centre_b, double size_b,
                const Pose& pose) {
    return kSlack *
           (length(centre_a) + size_a + length(centre_b) + size_b + length(pose.translation()));
}

/// How far the box reaches along an axis from its centre.
double reach(const std::array<Double3, 3>& axes, const Double3& half, const Double3& along) {
    return half.x * std::fabs(dot(axes[0], along)) + half.y * std::fabs(dot(axes[1], along)) +
           half.z * std::fabs(dot(axes[2], along));
}

}  // namespace

BoundingSphere bounding_sphere(const mesh::Mesh& mesh) {
    BoundingSphere sphere;
    if (mesh.positions.empty()) return sphere;
    sphere.centre = aligned_box(mesh).centre;
    const auto farthest = [&] {
        return *std::ranges::max_element(mesh.positions, {}, [&](const Double3& p) {
            const Double3 d = minus(p, sphere.centre);
            return dot(d, d);
        });
    };
    // The step towards the farthest point shrinks: the centre comes to that of the least.
    BoundingSphere best{sphere.centre, std::numeric_limits<double>::infinity()};
    for (int step = 1; step <= kSphereSteps; ++step) {
        const Double3 d = minus(farthest(), sphere.centre);
        if (length(d) < best.radius) best = {sphere.centre, length(d)};
        const double share = 1.0 / (step + 1);
        sphere.centre = {sphere.centre.x + share * d.x, sphere.centre.y + share * d.y,
                         sphere.centre.z + share * d.z};
    }
    best.radius *= 1 + 1e-14;
    return best;
}

BoundingBox aligned_box(const mesh::Mesh& mesh) {
    BoundingBox box;
    if (mesh.positions.empty()) return box;
    const format::Bounds bounds = convex::find_bounds(mesh);
    const auto middle = [](double low, double high) { return low + 0.5 * (high - low); };
    box.centre = {middle(bounds.lower.x, bounds.upper.x), middle(bounds.lower.y, bounds.upper.y),
                  middle(bounds.lower.z, bounds.upper.z)};
    const Double3 up = minus(bounds.upper, box.centre);
    const Double3 down = minus(box.centre, bounds.lower);
    box.half = {std::max(up.x, down.x), std::max(up.y, down.y), std::max(up.z, down.z)};
    return box;
}

BoundingBox oriented_box(const mesh::Mesh& mesh) {
    const format::Bounds bounds = convex::find_bounds(mesh);
    return {bounds.oriented_centre, bounds.axis, bounds.half_extent};
}

bool may_touch(const BoundingSphere& a, const BoundingSphere& b, const Pose& a_from_b) noexcept {
    const double slack = slack_of(a.centre, a.radius, b.centre, b.radius, a_from_b);
    const Double3 d = minus(moved(a_from_b, b.centre), a.centre);
    const double reaches = a.radius + b.radius + slack;
    return dot(d, d) <= reaches * reaches;
}

bool may_touch_aligned(const BoundingBox& a, const BoundingBox& b, const Pose& a_from_b) noexcept {
    const double slack = slack_of(a.centre, length(a.half), b.centre, length(b.half), a_from_b);
    const Double3 d = minus(moved(a_from_b, b.centre), a.centre);
    const auto& r = a_from_b.rotation();
    const auto row = [&](std::size_t i) {
        return std::fabs(r[i]) * b.half.x + std::fabs(r[i + 1]) * b.half.y +
               std::fabs(r[i + 2]) * b.half.z + slack;
    };
    return std::fabs(d.x) <= a.half.x + row(0) && std::fabs(d.y) <= a.half.y + row(3) &&
           std::fabs(d.z) <= a.half.z + row(6);
}

bool may_touch(const BoundingBox& a, const BoundingBox& b, const Pose& a_from_b) noexcept {
    const double slack = slack_of(a.centre, length(a.half), b.centre, length(b.half), a_from_b);
    const Double3 d = minus(moved(a_from_b, b.centre), a.centre);
    const std::array<Double3, 3> axes = {turned(a_from_b, b.axis[0]), turned(a_from_b, b.axis[1]),
                                         turned(a_from_b, b.axis[2])};
    // An axis of length up to 1 parts them when their shadows on it lie apart.
    const auto parts = [&](const Double3& along) {
        return std::fabs(dot(d, along)) >
               reach(a.axis, a.half, along) + reach(axes, b.half, along) + slack;
    };
    for (const Double3& along : a.axis) {
        if (parts(along)) return false;
    }
    for (const Double3& along : axes) {
        if (parts(along)) return false;
    }
    for (const Double3& of_a : a.axis) {
        for (const Double3& of_b : axes) {
            if (parts(cross(of_a, of_b))) return false;
        }
    }
    return true;
}

}  // namespace cdprep::study
