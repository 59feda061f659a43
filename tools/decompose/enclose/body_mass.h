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
    /// True if the mass is the sum over the pieces, so that overlaps count more than once. False if
    /// it is the mass of the volume that the mesh encloses.
    bool is_of_pieces = false;
};

/// Returns the mass of a mesh of uniform density. It is that of the solid if the mesh is closed and
/// has a volume, whichever way it is wound. Otherwise it is that of the pieces. Returns nothing if
/// those have no volume either. `density` is in kilograms per cubic metre; `metres_per_unit` 0
/// counts as 1.
[[nodiscard]] std::optional<WeighedBody> weigh(const mesh::Mesh& mesh, bool is_closed,
                                               std::span<const convex::ConvexHull> pieces,
                                               double density, double metres_per_unit);

}  // namespace cdprep::cli
