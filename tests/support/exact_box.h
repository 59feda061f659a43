// SPDX-License-Identifier: MIT
#pragma once

#include "core/moved_model.h"
#include "exact/triangle_contact.h"

namespace cdprep::test {

/// Returns true if the triangle and the solid box have a common point. Clips the triangle at the
/// plane of each face, in exact numbers, and tests that something remains. The box must be finite.
[[nodiscard]] bool touches_box_by_cutting(const Corners& t, const Box3& box);

}  // namespace cdprep::test
