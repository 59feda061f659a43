// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/api.h"

#include "exact/box3.h"
#include "exact/triangle_contact.h"

namespace cdprep {

/// Returns whether the triangle and the solid box have a common point. Exact: compares coordinates
/// and signs of orient2d() and orient3d() only. A box may be flat; one whose lower exceeds its
/// upper is empty. Corners may be collinear or equal.
[[nodiscard]] CDPREP_API bool triangle_touches_box(const Corners& t, const Box3& box) noexcept;

}  // namespace cdprep
