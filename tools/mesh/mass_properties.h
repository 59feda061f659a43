// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "mesh/mesh.h"

namespace cdprep::convex {

/// Returns the volume, centre and inertia of the solid that a closed mesh encloses. Sums signed
/// tetrahedra around the centre of the box. Returns nothing if the volume is 0 or a result
/// leaves the range of double. The mesh must be closed (Topology::closed). O(n).
[[nodiscard]] std::optional<format::MassProperties> find_mass_properties(const mesh::Mesh& mesh);

}  // namespace cdprep::convex
