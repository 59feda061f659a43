// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/mesh.h"

namespace cdprep::convex {

/// The largest differences between two correct results of find_mass_properties() on one mesh. Both
/// are sums of the same terms, added in any order, with or without fused multiplications.
struct MassError {
    double volume = 0;  ///< of the volume
    double area = 0;    ///< of the surface area; also of a part of the mesh
    /// Of a volume computed about any point of the box, not its centre; also of a part of the mesh.
    double volume_about_any = 0;
    double centre = 0;   ///< of each coordinate of the centre; infinite if it is not known
    double inertia = 0;  ///< of each entry; infinite if it is not known
};

/// Returns bounds of the rounding errors of the sums: twice the bounds of first order. The centre
/// and the inertia are not known if the volume is within its own error of 0. The error of a result
/// that leaves the range of double is infinite or NaN. O(n).
[[nodiscard]] MassError find_mass_error(const mesh::Mesh& mesh);

}  // namespace cdprep::convex
