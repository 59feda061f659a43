// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/disjoint_sets.h"

namespace cdprep::mesh {

using build::DisjointSets;

}  // namespace cdprep::mesh
