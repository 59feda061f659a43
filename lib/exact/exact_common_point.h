// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "exact/triangle_contact.h"

namespace cdprep {

/// Returns a common point of two triangles, with or without area. Each coordinate is the exact one,
/// rounded as by edge_on_plane(). Returns nothing if they do not touch. Never allocates. Takes
/// microseconds.
[[nodiscard]] std::optional<Double3> exact_common_point(const Corners& a,
                                                        const Corners& b) noexcept;

}  // namespace cdprep
