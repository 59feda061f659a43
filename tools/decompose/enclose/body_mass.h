// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>

#include "hull/convex_hull.h"
#include "mesh/mesh.h"
#include "write/hulls_file.h"

namespace cdprep::cli {

struct WeighedBody {
    write::BodyMass body;
    /// True if the mass is the sum over the parts, so that overlaps count more than once. False if
    /// it is the mass of the volume that the mesh encloses.
    bool is_of_parts = false;
};

/// Returns the mass of a mesh of uniform density. It is that of the solid if the mesh is balanced
/// and has a volume, whichever way it is wound. Otherwise it is that of the parts. Returns nothing
/// if those have no volume either. `density` is in kilograms per cubic metre; `metres_per_unit` 0
/// counts as 1.
[[nodiscard]] std::optional<WeighedBody> weigh(const mesh::Mesh& mesh, bool is_balanced,
                                               std::span<const convex::ConvexHull> parts,
                                               double density, double metres_per_unit);

}  // namespace cdprep::cli
