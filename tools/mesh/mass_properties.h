// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "mesh/mesh.h"

namespace cdprep::convex {

/// Integrates volume, centre and inertia over what a closed mesh encloses, as a
/// signed sum of tetrahedra about the box's centre. Nothing when the volume is
/// 0 or a result leaves the range of double. The mesh must be closed
/// (Topology::closed). O(n).
[[nodiscard]] std::optional<format::MassProperties> find_mass_properties(const mesh::Mesh& mesh);

}  // namespace cdprep::convex
