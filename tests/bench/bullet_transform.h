// SPDX-License-Identifier: MIT
#pragma once

#include <LinearMath/btTransform.h>

#include "cdprep/pose.h"

namespace cdprep {

inline btVector3 bullet_vector(const Double3& p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

inline btTransform bullet_transform(const Pose& pose) {
    const auto& r = pose.rotation();
    const auto f = [](double x) { return static_cast<btScalar>(x); };
    const btMatrix3x3 turn(f(r[0]), f(r[1]), f(r[2]), f(r[3]), f(r[4]), f(r[5]), f(r[6]), f(r[7]),
                           f(r[8]));
    return btTransform(turn, bullet_vector(pose.translation()));
}

}  // namespace cdprep
