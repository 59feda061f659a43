// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "accuracy/ladder.h"

namespace cdprep::study {

/// How far apart the models are, with permitted errors that shrink, and by their hulls alone.
/// Over the poses that do not touch. Every interval promises to hold the truth.
[[nodiscard]] Ladder climb_distance(const Climb& climb, Broken& broken);

}  // namespace cdprep::study
