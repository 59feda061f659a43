// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/component_numbers.h"
#include "validate/defects/finding_list.h"
#include "validate/defects/sound_mesh.h"

namespace cdprep::mesh {

/// Of a component, or of all.
struct SurfaceMeasure {
    double area = 0;
    double volume = 0;    ///< signed; means something only where the surface is balanced
    int volume_sign = 0;  ///< exact for those
};

struct SurfaceMeasures {
    SurfaceMeasure whole;
    std::vector<SurfaceMeasure> component;
};

/// Adds up areas and volumes, and finds triangles of zero area and slivers (CDP0202, 0203)
/// on the way. Sums are rounded, and cut to the largest double; the sign of a volume is
/// exact for components where `balanced`, and of the whole where all are. O(n).
[[nodiscard]] SurfaceMeasures measure_surface(const SoundMesh& sound,
                                              const ComponentNumbers& components,
                                              const std::vector<bool>& balanced,
                                              double sliver_ratio, FindingList& findings,
                                              DefectCounts& counts);

}  // namespace cdprep::mesh
