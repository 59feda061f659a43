// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "cdprep/format/bvh_shape.h"

namespace cdprep::build {

inline constexpr std::size_t kItemsPerTask = 4096;  ///< triangles
inline constexpr std::size_t kLeavesPerTask = kItemsPerTask / format::kBvhWidth;

}  // namespace cdprep::build
