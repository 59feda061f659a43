// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/vectors.h"

namespace cdprep::scenes {
namespace {

using mesh::plus;
using mesh::scaled;

/// A quaternion w + xi + yj + zk.
using Quaternion = std::array<double, 4>;

double dot(const Quaternion& p, const Quaternion& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
}

/// Returns a quaternion of a rotation, of any length. It divides by its largest component
/// (Shepperd 1978).
Quaternion quaternion_of(const std::array<double, 9>& r) {
    const double trace = r[0] + r[4] + r[8];
    const double largest = std::max({trace, r[0], r[4], r[8]});
    if (largest == trace) return {1 + trace, r[7] - r[5], r[2] - r[6], r[3] - r[1]};
    if (largest == r[0]) return {r[7] - r[5], 1 + r[0] - r[4] - r[8], r[1] + r[3], r[2] + r[6]};
    if (largest == r[4]) return {r[2] - r[6], r[1] + r[3], 1 + r[4] - r[0] - r[8], r[5] + r[7]};
    return {r[3] - r[1], r[2] + r[6], r[5] + r[7], 1 + r[8] - r[0] - r[4]};
}

Quaternion unit(Quaternion q) {
    const double length = std::sqrt(dot(q, q));
    for (double& number : q) number /= length;
    return q;
}

/// Returns the rotation at `share` of the shorter arc from p to q, which have length 1.
Quaternion slerp(const Quaternion& p, Quaternion q, double share) {
    double cosine = dot(p, q);
    if (cosine < 0) {
        cosine = -cosine;
        for (double& number : q) number = -number;
    }
    // Near 0 the sine would divide by rounding errors; there, the arc is straight.
    constexpr double kStraight = 1 - 1e-10;
    double first = 1 - share, second = share;
    if (cosine < kStraight) {
        const double angle = std::acos(cosine), sine = std::sin(angle);
        first = std::sin((1 - share) * angle) / sine;
        second = std::sin(share * angle) / sine;
    }
    Quaternion mixed{};
    for (std::size_t i = 0; i < 4; ++i) mixed[i] = first * p[i] + second * q[i];
    return mixed;
}

/// Returns the pose with another translation. The rotation keeps every bit.
Result<Pose> moved_to(const Pose& pose, const Double3& translation) {
    const auto& r = pose.rotation();
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], translation.x,
                            translation.y, translation.z});
}

Result<Pose> between(const KeyPose& before, const KeyPose& after, double time_s,
                     const Double3& offset) {
    const double share = (time_s - before.time_s) / (after.time_s - before.time_s);
    const Double3 place = plus(
        plus(scaled(before.pose.translation(), 1 - share), scaled(after.pose.translation(), share)),
        offset);
    if (before.pose.rotation() == after.pose.rotation()) return moved_to(before.pose, place);
    const Quaternion q = slerp(unit(quaternion_of(before.pose.rotation())),
                               unit(quaternion_of(after.pose.rotation())), share);
    return Pose::from_quaternion(q[0], q[1], q[2], q[3], place);
}

}  // namespace

Motion Motion::fixed(const Pose& pose) {
    return Motion({{0, pose}});
}

Motion Motion::path(std::vector<KeyPose> keys) {
    return Motion(std::move(keys));
}

Motion Motion::steady(const Pose& start, const Double3& velocity, const Double3& turn) {
    Motion motion({{0, start}});
    motion.velocity_ = velocity;
    motion.turn_ = turn;
    return motion;
}

bool Motion::moves() const noexcept {
    const auto is_zero = [](const Double3& v) { return v.x == 0 && v.y == 0 && v.z == 0; };
    return keys_.size() > 1 || !is_zero(velocity_) || !is_zero(turn_);
}

Result<Pose> Motion::at(double time_s, const Double3& offset) const {
    const auto after =
        std::upper_bound(keys_.begin(), keys_.end(), time_s,
                         [](double time, const KeyPose& key) { return time < key.time_s; });
    const KeyPose& before = after == keys_.begin() ? keys_.front() : *(after - 1);
    if (keys_.size() > 1) {
        if (after == keys_.begin() || after == keys_.end() || before.time_s == time_s) {
            return moved_to(before.pose, plus(before.pose.translation(), offset));
        }
        return between(before, *after, time_s, offset);
    }
    const Double3 place = plus(plus(before.pose.translation(), scaled(velocity_, time_s)), offset);
    const double speed = std::hypot(turn_.x, turn_.y, turn_.z);
    if (speed == 0 || time_s == 0) return moved_to(before.pose, place);
    const double half = speed * time_s / 2;
    const Double3 axis = scaled(turn_, std::sin(half) / speed);
    Result<Pose> turn = Pose::from_quaternion(std::cos(half), axis.x, axis.y, axis.z, {});
    if (!turn) return turn;
    const Result<Pose> start = moved_to(before.pose, {});
    Result<Pose> turned = composed_pose(*turn, *start);
    if (!turned) return turned;
    return moved_to(*turned, place);
}

}  // namespace cdprep::scenes
