// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/mesh_arrays.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

using build::Topology;

/// As build::find_topology().
[[nodiscard]] Topology find_topology(const Mesh& mesh);

}  // namespace cdprep::mesh
