// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/mesh.h"

namespace cdprep::convex {

/// By how much two honest results of find_mass_properties() may differ on one mesh: sums of
/// the same terms, added in any order, with or without fused multiplications.
struct MassError {
    double volume = 0;  ///< of the volume
    double area = 0;    ///< of the surface area; also of a part of the mesh
    /// Of a volume taken about any point of the box instead of its centre; also of a part.
    double volume_about_any = 0;
    double centre = 0;   ///< of each coordinate of the centre; infinite where it is not known
    double inertia = 0;  ///< of each entry; infinite where it is not known
};

/// Bounds the rounding errors of the sums, to first order, and doubles them. The centre and
/// the inertia are not known where the volume is within its own error of 0. Results that
/// leave the range of double have an error that is infinite or no number. O(n).
[[nodiscard]] MassError find_mass_error(const mesh::Mesh& mesh);

}  // namespace cdprep::convex
