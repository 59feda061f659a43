// SPDX-License-Identifier: MIT
#pragma once

#include "cells/cone_faces.h"

namespace cdprep::build {

/// How many times slack_of() a value may be off after a few more steps: 1.75, and what
/// adding them up rounds.
inline constexpr double kValueSlacks = 2;

/// Returns a bound from above of a linear function over the part of a triangle that lies in
/// the closed cone, which some does: proven, and within a few units in the last place of
/// the corners' where the planes cut it at no grazing angle; never more than the greatest
/// v + kValueSlacks * slack. `v` are its values at the corners, off by less than
/// FaceValues::slack each and of no more than twice the sizes; `f` is face_values() of cone
/// and triangle.
[[nodiscard]] double cone_maximum(const FaceValues& f, const std::array<double, 3>& v) noexcept;

}  // namespace cdprep::build
