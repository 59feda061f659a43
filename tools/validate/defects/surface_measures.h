// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/component_numbers.h"
#include "validate/defects/finding_list.h"
#include "validate/defects/sound_mesh.h"

namespace cdprep::mesh {

/// The area and volume of a component, or of the whole mesh.
struct SurfaceMeasure {
    double area = 0;
    double volume = 0;    ///< signed; meaningful only if the surface is balanced
    int volume_sign = 0;  ///< exact for balanced surfaces
};

struct SurfaceMeasures {
    SurfaceMeasure whole;
    std::vector<SurfaceMeasure> component;
};

/// Computes areas and volumes, and finds triangles of zero area and slivers (CDP0202, CDP0203).
/// Sums are rounded, and limited to the largest double. The sign of a volume is exact for
/// components where `balanced` is true; that of the whole is exact if all are. O(n).
[[nodiscard]] SurfaceMeasures measure_surface(const SoundMesh& sound,
                                              const ComponentNumbers& components,
                                              const std::vector<bool>& balanced,
                                              FindingList& findings, DefectCounts& counts);

}  // namespace cdprep::mesh
