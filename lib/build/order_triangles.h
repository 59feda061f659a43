// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/build_bvh.h"

namespace cdprep::build {

/// Fills bvh.order: the tree order of the triangles. Requires that bvh.frame is set.
void order_triangles(Bvh& bvh, std::span<const format::Double3> positions,
                     std::span<const format::Triangle> triangles, const BvhOptions& options);

}  // namespace cdprep::build
