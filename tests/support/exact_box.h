// SPDX-License-Identifier: MIT
#pragma once

#include "core/moved_model.h"
#include "exact/triangle_contact.h"

namespace cdprep::test {

/// Whether the triangle and the solid box have a common point: the triangle is cut at
/// each face's plane, in exact numbers, and something is left. The box is finite.
[[nodiscard]] bool touches_box_by_cutting(const Corners& t, const Box3& box);

}  // namespace cdprep::test
