// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/rigid_state.h"

#include <algorithm>
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

/// Returns a vector after a turn.
Double3 turned(const Quaternion& q, const Double3& p) {
    const Double3 u = {q[1], q[2], q[3]};
    const Double3 t = mesh::scaled(mesh::cross(u, p), 2);
    return mesh::plus(mesh::plus(p, mesh::scaled(t, q[0])), mesh::cross(u, t));
}

Quaternion inverse(const Quaternion& q) {
    return {q[0], -q[1], -q[2], -q[3]};
}

/// Returns a vector of the world along the principal axes of a body.
Double3 along_axes(const BodyMass& mass, const Quaternion& turn, const Double3& p) {
    const Double3 m = turned(inverse(turn), p);
    const auto& a = mass.model_from_axes;
    return {a[0] * m.x + a[3] * m.y + a[6] * m.z, a[1] * m.x + a[4] * m.y + a[7] * m.z,
            a[2] * m.x + a[5] * m.y + a[8] * m.z};
}

Double3 in_world(const BodyMass& mass, const Quaternion& turn, const Double3& along) {
    return turned(turn, rotated(mass.model_from_axes, along));
}

Double3 momentum_of(const BodyMass& mass, const Quaternion& turn, const Double3& spin) {
    const Double3 w = along_axes(mass, turn, spin), m = mass.moments;
    return in_world(mass, turn, {m.x * w.x, m.y * w.y, m.z * w.z});
}

Double3 spin_of(const BodyMass& mass, const Quaternion& turn, const Double3& momentum) {
    const Double3 l = along_axes(mass, turn, momentum), m = mass.moments;
    return in_world(mass, turn, {l.x / m.x, l.y / m.y, l.z / m.z});
}

}  // namespace

FreeMotion moved_freely(const BodyMass& mass, const RigidState& state, const Double3& shift,
                        const Double3& spin, const Double3& push, double seconds) noexcept {
    // Each round is more exact by a factor of at most 0.85 kMostSpinChange.
    constexpr int kRounds = 12;
    // Three steps, the second one backwards, are of the fourth order (Yoshida 1990).
    constexpr double kOuter = 1.3512071919596576;
    constexpr std::array kParts = {kOuter, 1 - 2 * kOuter, kOuter};
    const Double3 momentum = momentum_of(mass, state.turn, spin);
    FreeMotion now{moved(state, shift, push), spin};
    for (const double part : kParts) {
        const FreeMotion before = now;
        for (int round = 0; round < kRounds; ++round) {
            const Double3 last = now.spin;
            const Double3 mean = mesh::scaled(mesh::plus(before.spin, last), 0.5);
            now.state = moved(before.state, {}, mesh::scaled(mean, part * seconds));
            now.spin = spin_of(mass, now.state.turn, momentum);
            if (now.spin == last) break;
        }
    }
    return now;
}

// Let E be the sum of m w^2 over the axes, and L2 that of m^2 w^2. Both stay. Let M be the largest
// moment and m0 the smallest. The sum of w^2 is E / M + sum of w^2 (1 - m / M). As m >= m0, that is
// at most E / M + (E - L2 / M) / m0.
double most_spin(const BodyMass& mass, const RigidState& state, const Double3& spin) noexcept {
    const Double3 w = along_axes(mass, state.turn, spin), m = mass.moments;
    const Double3 l = {m.x * w.x, m.y * w.y, m.z * w.z};
    const auto [smallest, largest] = std::minmax({m.x, m.y, m.z});
    const double energy = mesh::dot(l, w);
    constexpr double kRounding = 1e-15;
    const double spare = std::max(energy - mesh::dot(l, l) / largest, 0.0) + kRounding * energy;
    return std::sqrt(energy / largest + spare / smallest);
}

// The spin is J L. The momentum L stays, and the inverse J of the inertia turns with the body. Let
// c be the mean of J's least and greatest moments, 1 / M and 1 / m0. The part c L of the spin
// stays. A turn by a small vector t changes the rest by t x (J - c) L - (J - c) (t x L). That is at
// most 2 |J - c| |L| |t|, and 2 |J - c| is 1 / m0 - 1 / M.
double most_spin_change(const BodyMass& mass, const RigidState& state,
                        const Double3& spin) noexcept {
    const Double3 momentum = momentum_of(mass, state.turn, spin);
    const auto [smallest, largest] = std::minmax({mass.moments.x, mass.moments.y, mass.moments.z});
    return std::sqrt(mesh::dot(momentum, momentum)) * (1 / smallest - 1 / largest);
}

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
