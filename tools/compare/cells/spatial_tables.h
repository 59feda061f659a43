// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "compare/cells/spatial_builds.h"
#include "study/table.h"

namespace cdprep::study {

/// What was measured of one mesh.
struct SpatialMesh {
    const StudyMesh* mesh;  ///< never null
    std::vector<SpatialBuild> builds;
};

/// Table 2 as it was printed, our figures at the paper's setting.
[[nodiscard]] Table spatial_table(const std::vector<SpatialMesh>& meshes);
/// All settings and structures of one mesh.
[[nodiscard]] Table spatial_details(const SpatialMesh& mesh);
/// What Table 2 implies, and whether it holds.
[[nodiscard]] std::vector<Check> spatial_checks(const std::vector<SpatialMesh>& meshes);

}  // namespace cdprep::study
