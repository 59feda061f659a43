// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/portable.h"

namespace cdprep {

/// The greatest relative error of one rounded operation in double.
inline constexpr double kUnit = 0x1p-53;
using format::kInfinity;

}  // namespace cdprep
