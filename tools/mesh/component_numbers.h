// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/mesh_arrays.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

using build::ComponentNumbers;

/// Numbers the components. Every vertex must be used. O(n).
[[nodiscard]] ComponentNumbers number_components(const Mesh& mesh);

}  // namespace cdprep::mesh
