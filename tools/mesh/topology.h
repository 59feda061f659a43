// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/mesh_arrays.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

using build::Topology;

/// Returns build::find_topology() of the mesh.
[[nodiscard]] Topology find_topology(const Mesh& mesh);

}  // namespace cdprep::mesh
