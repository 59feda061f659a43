// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include "cdprep/pose.h"

namespace cdprep::test {

/// Returns a uniformly distributed point in [-reach, reach]^3.
inline Double3 fine_point(std::mt19937& random, double reach) {
    std::uniform_real_distribution<double> place(-reach, reach);
    const double x = place(random), y = place(random), z = place(random);
    return {x, y, z};
}

/// Returns a uniformly distributed rotation with a translation in [-reach, reach]^3.
inline Pose random_pose(std::mt19937& random, double reach) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> within(-reach, reach);
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    const Double3 translation{within(random), within(random), within(random)};
    return Pose::from_quaternion(w, x, y, z, translation).value();
}

}  // namespace cdprep::test
