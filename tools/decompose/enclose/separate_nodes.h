// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::convex {

/// Returns the mesh with no vertex in two nodes, so that each component belongs to one node. New
/// vertices follow the others. `node_of` is per triangle; empty: one node.
[[nodiscard]] mesh::Mesh separate_nodes(const mesh::Mesh& mesh,
                                        std::span<const std::uint32_t> node_of);

}  // namespace cdprep::convex
