// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "accuracy/ladder.h"

namespace cdprep::study {

/// Whether two triangles touch, by arithmetic that gets wider, over the pairs that the float
/// stage leaves open or calls crossing and those that are as near as 1e-4 diagonals.
[[nodiscard]] Ladder climb_predicates(const Climb& climb, Broken& broken);

}  // namespace cdprep::study
