// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/pairs.h"

namespace cdprep {

/// Returns the options of a query with permitted errors of at least 0. A negative one or NaN
/// becomes 0: bounds computed with it would prove nothing.
[[nodiscard]] inline DistanceOptions with_valid_errors(DistanceOptions options) noexcept {
    if (!(options.relative_error > 0)) options.relative_error = 0;
    if (!(options.absolute_error > 0)) options.absolute_error = 0;
    return options;
}

}  // namespace cdprep
