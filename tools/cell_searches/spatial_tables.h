// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cell_searches/spatial_builds.h"
#include "study/table.h"

namespace cdprep::study {

/// The measurements of one mesh.
struct SpatialMesh {
    const StudyMesh* mesh;  ///< never null
    std::vector<SpatialBuild> builds;
};

/// Returns Table 2 as printed, with our figures at the comparative study's setting.
[[nodiscard]] Table spatial_table(const std::vector<SpatialMesh>& meshes);
/// Returns all settings and structures of one mesh.
[[nodiscard]] Table spatial_details(const SpatialMesh& mesh);
/// Checks the statements that Table 2 implies.
[[nodiscard]] std::vector<Check> spatial_checks(const std::vector<SpatialMesh>& meshes);

}  // namespace cdprep::study
