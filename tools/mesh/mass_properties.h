// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "mesh/mesh.h"

namespace cdprep::convex {

/// Returns the volume, centre and inertia of the solid that a balanced mesh encloses. Sums signed
/// tetrahedra around the centre of the box. Returns nothing if the volume is 0 or a result
/// leaves the range of double. The mesh must be balanced (Topology::balanced). O(n).
[[nodiscard]] std::optional<format::MassProperties> find_mass_properties(const mesh::Mesh& mesh);

/// An inertia tensor along its principal axes.
struct PrincipalInertia {
    std::array<double, 3> moments;  ///< rising
    std::array<double, 4> axes;     ///< the quaternion x, y, z, w that turns them into the model
};

/// Returns the principal moments and axes of a tensor with entries xx, yy, zz, xy, yz, zx.
[[nodiscard]] PrincipalInertia principal_inertia(const std::array<double, 6>& inertia);

}  // namespace cdprep::convex
