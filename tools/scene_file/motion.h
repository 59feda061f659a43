// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cdprep/pose.h"

namespace cdprep::scenes {

/// A pose at a time.
struct KeyPose {
    double time_s;
    Pose pose;
};

/// How an object moves: not at all, along key poses, or steadily.
class Motion {
public:
    /// Stays at a pose.
    [[nodiscard]] static Motion fixed(const Pose& pose);
    /// Passes through key poses, at least one, in the order of their times, which differ. Between
    /// two keys the translation is linear and the rotation follows the shorter arc (slerp,
    /// Shoemake 1985). Before the first key and after the last, the object stays.
    [[nodiscard]] static Motion path(std::vector<KeyPose> keys);
    /// Starts at a pose, and moves and turns at constant speeds. `velocity` is in model units per
    /// second. `turn` points along the axis through the object's origin, in the world; its length
    /// is in radians per second.
    [[nodiscard]] static Motion steady(const Pose& start, const Double3& velocity,
                                       const Double3& turn);

    /// Returns whether the pose changes with time.
    [[nodiscard]] bool moves() const noexcept;
    /// Returns the pose at a time, with `offset` added to its translation. Times from 0 on. Fails
    /// with bad_argument if the translation exceeds format::kMaxCoordinate.
    [[nodiscard]] Result<Pose> at(double time_s, const Double3& offset) const;

private:
    explicit Motion(std::vector<KeyPose> keys) : keys_(std::move(keys)) {}

    std::vector<KeyPose> keys_;  ///< not empty
    Double3 velocity_{};
    Double3 turn_{};
};

}  // namespace cdprep::scenes
