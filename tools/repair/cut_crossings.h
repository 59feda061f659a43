// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "mesh/stop.h"
#include "repair/mesh_meetings.h"

namespace cdprep::mesh {

struct CutMesh {
    RepairMesh mesh;
    /// A pair that still meets because rounding kept creating new meetings.
    std::optional<TriangleMeeting> left;
    std::string failed;  ///< why there is no mesh, as a clause; empty: there is one
};

/// Cuts triangles along each other. Afterwards any two share only corners and edges, or are
/// equal.
///
/// Cuts are made in exact arithmetic; then their ends are rounded to doubles. Triangles that
/// meet after that are cut again, a few times. Triangles of zero area are left out: other
/// triangles cut their edges. Equal positions become one vertex.
[[nodiscard]] CutMesh cut_crossings(RepairMesh mesh, const SearchOptions& search,
                                    const StopCheck& stop);

}  // namespace cdprep::mesh
