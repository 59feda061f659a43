// SPDX-License-Identifier: MIT
#pragma once

#include "cells/cone_faces.h"

namespace cdprep::build {

/// The error of a value after a few more steps, in units of slack_of(): 1.75, plus the rounding of
/// their sum.
inline constexpr double kValueSlacks = 2;

/// Returns an upper bound of a linear function over the part of a triangle that lies in the closed
/// cone. The part must not be empty. The bound is proven, and never more than the greatest v +
/// kValueSlacks * slack. Where the planes cut the part at no grazing angle, it is within a few
/// units in the last place of the corners'. `v` are the values at the corners. Each is off by less
/// than FaceValues::slack and is at most twice the size. `f` is face_values() of cone and triangle.
[[nodiscard]] double cone_maximum(const FaceValues& f, const std::array<double, 3>& v) noexcept;

}  // namespace cdprep::build
