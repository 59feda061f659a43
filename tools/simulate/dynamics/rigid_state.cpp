// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/rigid_state.h"

#include <cmath>
#include <cstddef>

#include "mesh/vectors.h"

namespace cdprep::dynamics {
namespace {

using Quaternion = std::array<double, 4>;

/// Divides by the largest of the four candidates, so that nothing cancels (Shepperd 1978).
Quaternion quaternion_of(const std::array<double, 9>& r) {
    const double trace = r[0] + r[4] + r[8];
    std::size_t largest = 0;
    double most = trace;
    for (std::size_t i = 0; i < 3; ++i) {
        if (r[4 * i] > most) {
            most = r[4 * i];
            largest = i + 1;
        }
    }
    Quaternion q{};
    const double root = std::sqrt(1 + 2 * most - trace);
    q[largest] = root / 2;
    const double s = 1 / (2 * root);
    const std::array<double, 3> odd = {r[7] - r[5], r[2] - r[6], r[3] - r[1]};
    if (largest == 0) return {root / 2, s * odd[0], s * odd[1], s * odd[2]};
    q[0] = s * odd[largest - 1];
    for (std::size_t i = 0; i < 3; ++i) {
        if (i + 1 != largest) q[i + 1] = s * (r[3 * i + largest - 1] + r[3 * (largest - 1) + i]);
    }
    return q;
}

Quaternion product(const Quaternion& p, const Quaternion& q) {
    return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

}  // namespace

RigidState state_of(const Pose& world_from_model, const Double3& centre) noexcept {
    return {transform_point(world_from_model, centre), quaternion_of(world_from_model.rotation())};
}

Result<Pose> pose_of(const RigidState& state, const Double3& centre) {
    const auto [w, x, y, z] = state.turn;
    Result<Pose> rotation = Pose::from_quaternion(w, x, y, z, {0, 0, 0});
    if (!rotation) return rotation;
    const Double3 t = mesh::minus(state.centre, rotated(rotation->rotation(), centre));
    return Pose::from_quaternion(w, x, y, z, t);
}

RigidState moved(const RigidState& state, const Double3& shift, const Double3& turn) noexcept {
    RigidState next = state;
    next.centre = mesh::plus(state.centre, shift);
    const double angle = std::sqrt(mesh::dot(turn, turn));
    if (angle == 0) return next;
    const double s = std::sin(angle / 2) / angle;
    next.turn = product({std::cos(angle / 2), s * turn.x, s * turn.y, s * turn.z}, state.turn);
    const auto [w, x, y, z] = next.turn;
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    for (double& part : next.turn) part /= length;
    return next;
}

}  // namespace cdprep::dynamics
