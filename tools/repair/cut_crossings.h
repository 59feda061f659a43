// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "repair/mesh_meetings.h"
#include "mesh/stop.h"

namespace cdprep::mesh {

struct CutMesh {
    RepairMesh mesh;
    /// A pair that still meets, when rounding kept making new ones.
    std::optional<TriangleMeeting> left;
    std::string failed;  ///< why there is no mesh, as a clause; empty: there is one
};

/// Cuts triangles along each other until any two have nothing in common but corners and
/// edges, or are the same.
///
/// Cuts are made in exact arithmetic, then their ends are rounded to doubles; what meets
/// after that is cut again, a few times. Triangles without area are left out: their edges
/// are cut by the others. Equal positions become one vertex.
[[nodiscard]] CutMesh cut_crossings(RepairMesh mesh, const SearchOptions& search,
                                    const StopCheck& stop);

}  // namespace cdprep::mesh
