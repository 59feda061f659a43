// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace cdprep {

/// The greatest relative error of one rounded operation in double.
inline constexpr double kUnit = 0x1p-53;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace cdprep
