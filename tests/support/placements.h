// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/pose.h"

namespace cdprep::test {

/// B moves by this vector.
inline Placement shifted(const Double3& by) {
    return Placement::b_moves(
        Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, by.x, by.y, by.z}).value());
}

/// Returns one of the four kinds of placement, by `kind` modulo 4. Kinds with one pose use `pose`.
inline Placement placement_of_kind(unsigned kind, const Pose& pose, const Pose& other) {
    switch (kind % 4) {
        case 0:
            return Placement::b_moves(pose);
        case 1:
            return Placement::a_moves(pose);
        case 2:
            return Placement::relative(pose, other);
        default:
            return Placement::world(pose, other);
    }
}

}  // namespace cdprep::test
