// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Returns one bit per triangle, 64 per word, set if its corners are exactly collinear. Returns
/// no words if no triangle is degenerate.
[[nodiscard]] std::vector<std::uint64_t> find_degenerate(const Mesh& mesh,
                                                         ParallelFor parallel_for);

}  // namespace cdprep::mesh
