// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "accuracy/ladder.h"

namespace cdprep::study {

/// Whether the models touch, by shapes around them that fit better and better: a sphere, boxes,
/// the hull, convex pieces, levels of a tetra-tree and of an octree, the hierarchy of boxes in
/// float without its exact stage, and with it. All shapes enclose, so they promise not to miss.
[[nodiscard]] Ladder climb_geometry(const Climb& climb, Broken& broken);

}  // namespace cdprep::study
